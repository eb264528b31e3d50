#pragma once

// Structured mutations of text files, the same for the same seed.

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace tremie::test {

inline const std::vector<std::string>& hostile_values() {
  static const std::vector<std::string> values{"0",
                                               "-1",
                                               "1e300",
                                               "-1e300",
                                               "1e-300",
                                               "nan",
                                               "inf",
                                               "-inf",
                                               "true",
                                               "[]",
                                               "{}",
                                               "\"\"",
                                               "\"0\"",
                                               "\"54\"",
                                               "\"-54 Pa\"",
                                               "\"54 Pa\"",
                                               "\"54 kg\"",
                                               "\"1e300 Pa\"",
                                               "\"1e-300 s\"",
                                               "\"1e300 s\"",
                                               "\"0 s\"",
                                               "\"0 m\"",
                                               "\"1e-12 m\"",
                                               "\"1e12 m\"",
                                               "\"1 mm\"",
                                               "\"0.5 m\"",
                                               "\"400 mm\"",
                                               "\"instant\"",
                                               "\"exact\"",
                                               "\"papanastasiou\"",
                                               "\"explicit\"",
                                               "\"explicit_usf\"",
                                               "\"full\"",
                                               "\"plane\"",
                                               "\"nan Pa\"",
                                               "\"inf s\"",
                                               "\"5e3 Pa\"",
                                               "\"0.01 Pa.s\"",
                                               "\"1000 Pa.s\"",
                                               "\"2 GPa\"",
                                               "\"10 kPa\"",
                                               "\"1e6 s\"",
                                               "\"10 m/s\"",
                                               "\"1 mm/s\"",
                                               "\"1e3 rev/s\"",
                                               "\"1e-6 rev/s\"",
                                               "[1, 2, 3]",
                                               "[64, 64]",
                                               "[\"1 mm\", \"100 mm\"]",
                                               "64",
                                               "1",
                                               "99999999999999999999",
                                               "1979-05-27",
                                               "\"\\u0000\"",
                                               "\"\\u202e54 Pa\"",
                                               "'''54 Pa'''",
                                               "\"54,5 Pa\"",
                                               "\"5 4 Pa\"",
                                               "\"54 Pa Pa\"",
                                               "0x36",
                                               "1_000",
                                               "\"mix_a\"",
                                               "\"../../etc\"",
                                               "false"};
  return values;
}

/// Changes one to three lines: a value, a key, a line twice, a line away, two lines changed over, a byte, the end.
class Mutation {
 public:
  explicit Mutation(unsigned seed) : random_(seed) {}

  std::string operator()(const std::string& text) {
    std::vector<std::string> lines = lines_of(text);
    for (std::size_t n = below(3) + 1; n > 0 && !lines.empty(); --n) change(lines);
    std::string changed;
    for (const std::string& line : lines) changed += line + '\n';
    if (below(20) == 0 && !changed.empty()) changed.resize(below(changed.size()));
    if (below(20) == 0 && !changed.empty()) changed[below(changed.size())] = static_cast<char>(below(256));
    return changed;
  }
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

 private:
  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return lines;
  }
  /// A line that sets something, where there is one.
  std::string& assignment(std::vector<std::string>& lines) {
    for (int tried = 0; tried < 20; ++tried)
      if (std::string& line = lines[below(lines.size())];
          line.find('=') != std::string::npos && line[0] != '#')
        return line;
    return lines[below(lines.size())];
  }
  void change(std::vector<std::string>& lines) {
    const std::size_t at = below(lines.size());
    switch (below(9)) {
      case 0:
        lines.push_back(lines[at]);
        break;
      case 1:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 2:
        std::swap(lines[at], lines[below(lines.size())]);
        break;
      case 3:
        lines[at] += lines[below(lines.size())];
        break;
      case 4:
        set_number(assignment(lines));
        break;
      default:
        set_value(assignment(lines));
        break;
    }
  }
  /// Another value behind the first or the last =.
  void set_value(std::string& line) {
    const std::size_t at = below(2) == 0 ? line.find('=') : line.rfind('=');
    if (at == std::string::npos) return;
    const bool table = line.find('}', at) != std::string::npos;
    line =
        line.substr(0, at + 1) + ' ' + hostile_values()[below(hostile_values().size())] + (table ? "}" : "");
  }
  /// Another power of ten for a number in place.
  void set_number(std::string& line) {
    const std::size_t from = line.find('='),
                      at = line.find_first_of("0123456789", from == std::string::npos ? 0 : from);
    if (at == std::string::npos) return;
    std::size_t end = line.find_first_not_of("0123456789.e", at);
    if (end == std::string::npos) end = line.size();
    const int power = static_cast<int>(below(17)) - 8;
    std::string exponent = "e";
    exponent += std::to_string(power);
    line.insert(end, exponent);
  }

  std::mt19937 random_;
};

}  // namespace tremie::test

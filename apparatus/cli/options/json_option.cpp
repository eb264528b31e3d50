#include "apparatus/cli/options/json_option.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iterator>

#include "apparatus/cli/process/say.hpp"

namespace tremie::cli {

void add_json_option(Command& command, bool& json) {
  command.flag("--json", json, "Print one JSON object, the result's summary, and nothing else");
}

void add_crate_option(Command& command, bool& crate) {
  command.flag("--crate", crate,
               "Also describe the files, the program and the mix in ro-crate-metadata.json (RO-Crate 1.1)");
}

void print_json_of(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "summary.json", std::ios::binary);
  answer(std::string(std::istreambuf_iterator<char>(stream), {}));
}

void print_result_as_json(const std::filesystem::path& folder, const std::vector<std::string>& notes) {
  print_json_of(folder);
  for (const auto& note : notes) say(stderr, "note: {}\n", note);
  say(stderr, "written to {}\n", folder.string());
}

}  // namespace tremie::cli

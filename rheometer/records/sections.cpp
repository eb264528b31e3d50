#include "rheometer/records/sections.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/records/ramps.hpp"
#include "rheometer/records/rests.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie {

namespace {

constexpr double drift = 0.015;

/// A run of rows: of constant speed, or between such runs.
struct Piece {
  std::size_t begin = 0, end = 0;
  bool constant = false;

  std::size_t size() const { return end - begin; }
};

/// The rows from `begin` on that keep the speed; their mean follows the first five.
std::size_t end_of_constant(const std::vector<double>& omega, std::size_t begin, std::size_t end) {
  double sum = omega[begin], rows = 1.0;
  std::size_t i = begin + 1;
  for (; i < end && std::abs(omega[i] - sum / rows) <= same_speed * sum / rows; ++i)
    if (rows < 5.0) sum += omega[i], rows += 1.0;
  return i;
}

/// A slow ramp keeps its speed for a few rows too, but drifts through all of the tolerance; so does the turn between a
/// ramp up and one down, there and back.
bool drifts(const std::vector<double>& omega, std::size_t begin, std::size_t end) {
  const std::size_t third = std::max<std::size_t>(1, (end - begin) / 3);
  double first = 0.0, last = 0.0, middle = 0.0;
  const auto n = static_cast<double>(third), between = static_cast<double>(end - begin) - 2.0 * n;
  for (std::size_t i = 0; i < third; ++i) first += omega[begin + i] / n, last += omega[end - 1 - i] / n;
  for (std::size_t i = begin + third; i + third < end; ++i) middle += omega[i] / between;
  const bool turns = between > 0.0 && std::abs(middle - 0.5 * (first + last)) > drift * first;
  return std::abs(last - first) > drift * first || turns;
}

/// Whether a step of the test begins at row i: the clock starts again, and the speed does not go on as it went.
bool begins_a_step(const ProtocolRecord& r, std::size_t i) {
  if (!std::binary_search(r.restarts.begin(), r.restarts.end(), i)) return false;
  if (i < 2 || i + 1 >= r.omega.size()) return false;
  const auto rises = [&](std::size_t k) { return r.omega[k] > r.omega[k - 1]; };
  return rises(i - 1) != rises(i) || rises(i) != rises(i + 1);
}

std::vector<Piece> pieces_of(const ProtocolRecord& r, std::size_t begin, std::size_t end) {
  const std::vector<double>& omega = r.omega;
  std::vector<Piece> pieces;
  for (std::size_t i = begin; i < end;) {
    const std::size_t stop = end_of_constant(omega, i, end);
    if (stop - i >= fewest_rows && !drifts(omega, i, stop)) {
      pieces.push_back({i, stop, true});
      i = stop;
    } else {
      if (pieces.empty() || pieces.back().constant || begins_a_step(r, i)) pieces.push_back({i, i, false});
      pieces.back().end = ++i;
    }
  }
  return pieces;
}

/// Few rows before a constant speed are the vane's start, few rows behind it its stop: they belong to it.
std::vector<Piece> without_transitions(std::vector<Piece> pieces) {
  std::vector<Piece> kept;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Piece p = pieces[i];
    const bool next = i + 1 < pieces.size() && pieces[i + 1].constant;
    const std::size_t near = std::max(next ? pieces[i + 1].size() : 0, kept.empty() ? 0 : kept.back().size());
    if (!p.constant && p.size() <= std::max<std::size_t>(fewest_rows - 1, near / 10)) {
      if (next) {
        pieces[i + 1].begin = p.begin;
        continue;
      }
      if (!kept.empty()) {
        kept.back().end = p.end;
        continue;
      }
    }
    kept.push_back(p);
  }
  return kept;
}

double median_speed(const std::vector<double>& omega, const Piece& p) {
  std::vector<double> v(omega.begin() + static_cast<std::ptrdiff_t>(p.begin),
                        omega.begin() + static_cast<std::ptrdiff_t>(p.end));
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

double highest(const std::vector<double>& omega, std::size_t begin, std::size_t end) {
  return *std::max_element(omega.begin() + static_cast<std::ptrdiff_t>(begin),
                           omega.begin() + static_cast<std::ptrdiff_t>(end));
}

/// How many of the pieces from i on are steps of one flow curve, up or down; fewer than 3 are none. A first step that
/// takes more than 2.5 times as many rows as the others is a pre-shear.
std::size_t steps_from(const std::vector<Piece>& pieces, const std::vector<double>& speed, std::size_t i,
                       bool up) {
  std::size_t n = 1;
  while (i + n < pieces.size() && pieces[i + n].constant && pieces[i].constant &&
         (up ? speed[i + n] > 1.03 * speed[i + n - 1] : speed[i + n] < 0.97 * speed[i + n - 1]))
    ++n;
  if (n < 3) return 0;
  return 2 * pieces[i].size() > 5 * pieces[i + 1].size() ? 0 : n;
}

/// Sections of rows in which the vane turns.
void add_shear(const ProtocolRecord& r, std::size_t begin, std::size_t end, std::vector<Section>& sections) {
  const std::vector<double>& omega = r.omega;
  const std::vector<Piece> pieces = without_transitions(pieces_of(r, begin, end));
  std::vector<double> speed;
  for (const Piece& p : pieces) speed.push_back(median_speed(omega, p));
  for (std::size_t i = 0; i < pieces.size();) {
    const std::size_t up = steps_from(pieces, speed, i, true), down = steps_from(pieces, speed, i, false);
    if (const std::size_t n = std::max(up, down); n > 0) {
      sections.push_back(flow_curve_section(omega, pieces[i].begin, pieces[i + n - 1].end, up > 0, true));
      i += n;
      continue;
    }
    if (pieces[i].constant) {
      sections.push_back({.kind = SectionKind::constant_rate,
                          .begin = pieces[i].begin,
                          .end = pieces[i].end,
                          .omega = speed[i]});
    } else {
      add_ramps(omega, pieces[i].begin, pieces[i].end, sections);
    }
    ++i;
  }
}

/// Rests before, start-ups and the pre-shear: what a section is by what lies around it.
void name_by_neighbours(const ProtocolRecord& r, double fastest, std::vector<Section>& sections) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    Section& s = sections[i];
    if (i > 0 && sections[i - 1].kind == SectionKind::rest) {
      const Section& rest = sections[i - 1];
      s.rest_before = r.time[rest.end - 1] - r.time[rest.begin > 0 ? rest.begin - 1 : 0];
    }
    if (s.kind != SectionKind::constant_rate) continue;
    const bool slow = s.omega < 0.1 * fastest || (s.rest_before > 0.0 && s.omega < 0.3 * fastest);
    if (slow) s.kind = SectionKind::start_up;
  }
  for (Section& s : sections) {
    if (s.kind == SectionKind::rest) continue;
    s.pre_shear = s.kind == SectionKind::constant_rate && &s != &sections.back() && s.omega > 0.5 * fastest;
    break;
  }
}

}  // namespace

std::string_view name_of(SectionKind kind) {
  switch (kind) {
    case SectionKind::rest:
      return "rest";
    case SectionKind::start_up:
      return "start-up";
    case SectionKind::constant_rate:
      return "constant rate";
    case SectionKind::flow_curve_up:
      return "flow curve up";
    case SectionKind::flow_curve_down:
      return "flow curve down";
    case SectionKind::other:
      break;
  }
  return "other";
}

ProtocolRecord protocol_of(const NumberTable& table) {
  ProtocolRecord r;
  r.time = table.column[0];
  double carried = 0.0;
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    if (i > 0 && table.column[0][i] < table.column[0][i - 1]) {
      carried = r.time[i - 1] - std::min(0.0, table.column[0][i]);
      r.restarts.push_back(i);
    }
    r.time[i] += carried;
  }
  for (const double w : table.column[1]) r.omega.push_back(std::abs(w));
  r.torque = table.column[2];
  r.line = table.line;
  return r;
}

std::vector<Section> find_sections(const ProtocolRecord& r) {
  std::vector<Section> sections;
  if (r.omega.empty()) return sections;
  const std::size_t rows = r.omega.size();
  const std::vector<char> rests = rests_of(r);
  for (std::size_t begin = 0, end = 0; begin < rows; begin = end) {
    for (end = begin + 1; end < rows && rests[end] == rests[begin]; ++end) {
    }
    if (rests[begin])
      sections.push_back({.kind = SectionKind::rest, .begin = begin, .end = end});
    else
      add_shear(r, begin, end, sections);
  }
  name_by_neighbours(r, highest(r.omega, 0, rows), sections);
  return sections;
}

std::size_t peak_of(const ProtocolRecord& r, const Section& s) {
  std::size_t peak = s.begin;
  const std::size_t limit = s.begin + std::max<std::size_t>(3, (s.end - s.begin) / 10);
  for (std::size_t i = s.begin; i < std::min(limit, s.end); ++i)
    if (r.torque[i] > r.torque[peak]) peak = i;
  return peak;
}

TorqueRecord decay_of(const ProtocolRecord& r, const Section& s) {
  TorqueRecord d;
  d.kind = RecordKind::torque_decay;
  d.speed = s.omega;
  d.rest = s.rest_before;
  d.sheared_evenly = r.sheared_evenly;
  const std::size_t peak = peak_of(r, s);
  for (std::size_t i = peak; i < s.end; ++i) {
    d.time.push_back(r.time[i] - r.time[peak]);
    d.torque.push_back(r.torque[i]);
    d.line.push_back(r.line[i]);
  }
  return d;
}

TorqueRecord flow_curve_of(const ProtocolRecord& r, const Section& s) {
  TorqueRecord c;
  c.kind = RecordKind::flow_curve;
  c.sheared_evenly = r.sheared_evenly;
  const auto add = [&](double omega, double torque, long line) {
    c.omega.push_back(omega);
    c.torque.push_back(torque);
    c.line.push_back(line);
  };
  if (!s.stepped) {
    for (std::size_t i = s.begin; i < s.end; ++i) add(r.omega[i], r.torque[i], r.line[i]);
    return c;
  }
  for (std::size_t from = s.begin, to = from; from < s.end; from = to) {
    for (to = from + 1; to < s.end && std::abs(r.omega[to] / r.omega[from] - 1.0) <= 0.03; ++to) {
    }
    if (to - from < 3) continue;
    double omega = 0.0, torque = 0.0, n = 0.0;
    for (std::size_t i = from + (to - from) / 2; i < to; ++i)
      omega += r.omega[i], torque += r.torque[i], n += 1.0;
    add(omega / n, torque / n, r.line[from]);
  }
  return c;
}

ProtocolRecord parse_protocol_record(std::string_view bytes, const std::string& name, double torque_offset,
                                     const ReadOptions& options) {
  bool sheared_evenly = false;
  const NumberTable table = torque_table(bytes, name, torque_offset, options, sheared_evenly);
  for (std::size_t q = 0; q < 3; ++q)
    if (table.position[q] == 0)
      throw RecordError(at_position(name, std::max(1L, table.header_line), 1,
                                    "--protocol needs columns of time, speed and torque; there is none of " +
                                        std::string(torque_quantities()[q].name)));
  if (table.line.empty()) throw RecordError(at_position(name, table.header_line, 1, "a header without rows"));
  ProtocolRecord record = protocol_of(table);
  record.understood = table.understood;
  record.sheared_evenly = sheared_evenly;
  const double fastest = highest(record.omega, 0, record.omega.size());
  for (std::size_t i = 0; i < record.torque.size(); ++i)
    if (record.torque[i] < 0.0 && record.omega[i] > 5e-4 * fastest)
      throw RecordError(
          at_position(name, record.line[i], table.position[2],
                      "the torque is negative while the vane turns; give its magnitude, or the offset "
                      "of the unloaded instrument, --torque-offset \"-0.3 mN.m\""));
  if (!record.restarts.empty())
    record.understood.push_back("the clock starts again at " + std::to_string(record.restarts.size()) +
                                " rows, the first on line " +
                                std::to_string(record.line[record.restarts[0]]) + "; time is carried on");
  return record;
}

}  // namespace tremie

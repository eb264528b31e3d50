// tremie estimate: yield stress and plastic viscosity from a spread or a slump, in milliseconds.

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <memory>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/estimate/estimate.hpp"
#include "apparatus/estimate/estimate_json.hpp"
#include "apparatus/estimate/rheograph.hpp"
#include "apparatus/report/process.hpp"
#include "apparatus/scene/document.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

using scene::Dimension;

struct EstimateOptions {
  std::string cone, spread, slump, t500, viscosity, density, spread_error, slump_error, t500_error, chart;
  bool json = false;
};

void needs(const char* error, const std::string& given, const char* of, const std::string& value) {
  if (!given.empty() && value.empty()) throw scene::InputError(fmt::format("{}: goes with {}", error, of));
}

estimate::Measured measured_of(const EstimateOptions& o, const estimate::Mould& mould) {
  estimate::Measured m;
  const auto sensible = [&](double length) {
    return length > 0.2 * mould.height && length < 10.0 * mould.foot;
  };
  m.spread = quantity("--spread", o.spread, Dimension::length, sensible);
  m.slump = quantity("--slump", o.slump, Dimension::length, sensible);
  m.t500 = quantity("--t500", o.t500, Dimension::time);
  m.mu = quantity("--plastic-viscosity", o.viscosity, Dimension::viscosity);
  m.density = quantity("--density", o.density, Dimension::density).value_or(m.density);
  m.spread_error = quantity("--spread-error", o.spread_error, Dimension::length).value_or(m.spread_error);
  m.slump_error = quantity("--slump-error", o.slump_error, Dimension::length).value_or(m.slump_error);
  m.t500_error = quantity("--t500-error", o.t500_error, Dimension::time).value_or(m.t500_error);
  needs("--spread-error", o.spread_error, "--spread", o.spread);
  needs("--slump-error", o.slump_error, "--slump", o.slump);
  needs("--t500-error", o.t500_error, "--t500", o.t500);
  estimate::check_readings(m, mould);
  return m;
}

void print_interval(const char* name, const std::optional<estimate::Interval>& i, const char* unit,
                    const char* none) {
  if (i)
    say("{:<24} {} {} [{}, {}]\n", name, scene::rounded(i->value, 3), unit, scene::rounded(i->low, 3),
        scene::rounded(i->high, 3));
  else
    say("{:<24} {}\n", name, none);
}

void print_text(const EstimateOptions& o, const estimate::Measured& m, const estimate::MixEstimate& e) {
  answer("");
  print_interval("yield stress", e.tau_0, "Pa", "not in the table");
  print_interval("plastic viscosity", e.mu, "Pa.s",
                 o.t500.empty() ? "needs --t500" : "not identifiable from this t500");
  if (!m.t500 && !m.mu) say("{:<24} --plastic-viscosity narrows the yield stress\n", "");
  if (m.spread) {
    say("{:<24} {} Pa (thin layer at rest, Roussel and Coussot)\n", "by the closed forms",
        scene::rounded(*e.tau_0_thin_layer, 3));
    say("{:<24} {} Pa (with the plug's normal stress)\n", "", scene::rounded(*e.tau_0_plug, 3));
  }
  std::string read;
  const auto add = [&](bool given, const char* name, double error, const char* unit) {
    if (given) read += fmt::format(", {} read to {:.3g} {}", name, error, unit);
  };
  add(m.spread.has_value(), "spread", 1e3 * m.spread_error, "mm");
  add(m.slump.has_value(), "slump", 1e3 * m.slump_error, "mm");
  add(m.t500.has_value(), "t500", m.t500_error, "s");
  say("{:<24} 95 %; {:.0f} kg/m3{} (one standard error), at rest, floor without slip\n", "intervals",
      m.density, read);
}

/// The published mixes of reference_data that have a yield stress and a viscosity.
std::vector<estimate::NamedMix> published_mixes() {
  std::vector<estimate::NamedMix> mixes;
  for (const auto& folder : scene::data_folders())
    for (const auto& name : scene::mix_names()) {
      const auto file = folder / "mixes" / (name + ".toml");
      std::error_code error;
      if (!std::filesystem::is_regular_file(file, error)) continue;
      const auto document = scene::parse_file(file);
      const auto text = [&](const char* key) {
        const auto* table = scene::find(document, "mix");
        const auto* node = table ? scene::find(*table, key) : nullptr;
        const auto* value = node ? std::get_if<std::string>(&node->value) : nullptr;
        return value ? *value : std::string();
      };
      const auto tau_0 = quantity(name.c_str(), text("yield_stress"), Dimension::pressure);
      const auto mu = quantity(name.c_str(), text("plastic_viscosity"), Dimension::viscosity);
      if (tau_0 && mu) mixes.push_back({text("name"), *tau_0, *mu});
    }
  return mixes;
}

/// Whether a file is an SVG that was drawn here.
bool is_rheograph(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, error))) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string begin(400, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.starts_with("<svg") &&
         begin.find("Slump flow and t500 of fresh concrete") != std::string::npos;
}

/// SVG, or PDF by rsvg-convert.
void draw_chart(const EstimateOptions& options, const estimate::SlumpTable& table,
                const std::optional<estimate::MixEstimate>& result) {
  namespace fs = std::filesystem;
  const fs::path file = fs::absolute(options.chart);
  const bool pdf = file.extension() == ".pdf";
  if (file.extension() != ".svg" && !pdf) throw scene::InputError("--chart: must end with .svg or .pdf");
  if (!fs::is_directory(file.parent_path()))
    throw scene::InputError(fmt::format("--chart: there is no folder {}", file.parent_path().string()));
  const auto converter = pdf ? report::find_program("rsvg-convert") : fs::path();
  if (pdf && converter.empty())
    throw scene::InputError(
        "--chart: a PDF takes rsvg-convert (librsvg2-bin), which is not installed here; a file.svg "
        "takes nothing");
  std::error_code error;
  if (fs::exists(fs::symlink_status(file, error)) && !is_rheograph(file))
    throw scene::InputError(fmt::format(
        "--chart: {} is there already, and is no SVG of this command: not replaced", file.string()));
  const fs::path svg =
      pdf ? file.parent_path() / fmt::format(".{}.{}.svg", file.filename().string(), getpid()) : file;
  io::write_text(svg, estimate::rheograph_svg(table, published_mixes(), result));
  if (!pdf) return;
  const auto code = report::run_program(
      converter, {"--format=pdf", "--output=" + file.string(), svg.string()}, file.parent_path());
  fs::remove(svg);
  if (code != 0) throw std::runtime_error("rsvg-convert failed: the chart is missing or not complete");
}

int run_estimate(const EstimateOptions& options) {
  const auto table = estimate::find_slump_table(scene::data_folders(), options.cone);
  if (!options.chart.empty() && options.cone != estimate::Mould{}.name)
    throw scene::InputError("--chart: is drawn of the Abrams cone alone");
  if (options.spread.empty() && options.slump.empty()) {
    if (options.chart.empty())
      throw scene::InputError("--spread: is missing, and so is --slump; without both, --chart alone");
    draw_chart(options, table, {});
    return done;
  }
  const auto measured = measured_of(options, table.mould);
  const auto result = estimate::estimate(table, measured);
  if (!options.chart.empty()) draw_chart(options, estimate::at_density(table, measured.density), result);
  options.json ? answer(estimate::estimate_json(result) + "\n") : print_text(options, measured, result);
  for (const auto& reason : result.reasons) say(stderr, "not to be trusted: {}\n", reason);
  return result.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_estimate(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<EstimateOptions>();
  o->cone = estimate::Mould{}.name;
  Command command(app, "estimate", "Estimate yield stress and plastic viscosity from a spread or a slump");
  command.option("--spread", o->spread, "Spread at rest: \"590 mm\"");
  command.option("--slump", o->slump, "Slump: \"120 mm\"");
  command.option("--t500", o->t500, "Time to 500 mm from the start of the lift: \"2.5 s\"");
  command.option("--plastic-viscosity", o->viscosity,
                 "Known plastic viscosity: narrows the yield stress of mixes that do not reach 500 mm");
  command.option("--cone", o->cone,
                 "Mould by its name in reference_data/cones: \"haegermann\" (default: \"abrams\")");
  command.option("--density", o->density, "Density (default: \"2400 kg/m3\")");
  command.option("--spread-error", o->spread_error, "Standard error of the spread (default: \"15 mm\")");
  command.option("--slump-error", o->slump_error, "Standard error of the slump (default: \"10 mm\")");
  command.option("--t500-error", o->t500_error, "Standard error of t500 (default: \"0.2 s\")");
  command.option("--chart", o->chart,
                 "Draw a rheograph to FILE.svg or FILE.pdf: contours of slump flow and t500");
  command.flag("--json", o->json, "Print one JSON object");
  command.example("tremie estimate --spread \"590 mm\" --t500 \"2.5 s\"");
  command.example("tremie estimate --slump \"120 mm\"");
  command.example("tremie estimate --cone haegermann --spread \"210 mm\" --spread-error \"3 mm\"");
  command.run([o, &exit_code] { exit_code = run_estimate(*o); });
}

}  // namespace tremie::cli

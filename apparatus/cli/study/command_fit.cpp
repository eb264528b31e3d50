#include "apparatus/cli/study/command_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/fit/fit_output.hpp"
#include "apparatus/cli/fit/fit_protocol.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/fit_csv.hpp"
#include "apparatus/report/fit_input.hpp"
#include "apparatus/report/fit_page/fit_page.hpp"
#include "apparatus/report/fit_page/protocol_page.hpp"
#include "apparatus/report/fit_page/replicates_page.hpp"
#include "apparatus/report/fit_results.hpp"
#include "apparatus/report/folder/crate.hpp"
#include "apparatus/report/folder/own_files.hpp"
#include "apparatus/report/protocol_results.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "libmpm/io/write_error.hpp"
#include "rheometer/whole_fit/fit_record.hpp"

namespace tremie::cli {
namespace {

struct Given {
  std::vector<std::string> data;
  std::string out;
  std::vector<std::string> texts = std::vector<std::string>(fit_options().size());  ///< of fit_options()
  std::deque<bool> flags = std::deque<bool>(fit_options().size());
  bool json = false, quiet = false, force = false, crate = false;
};

FitOptions options_of(const Given& o) {
  FitOptions options;
  for (std::size_t i = 0; i < o.texts.size(); ++i) {
    const FitOption& option = fit_options()[i];
    if (option.is_flag())
      set_option(options, option, o.flags[i]);
    else if (!o.texts[i].empty())
      report::read_option(options, option, report::command_name(option), o.texts[i]);
  }
  return options;
}

/// With the record's name, where the message is of a record and lacks it.
std::string with_name(const std::string& message, const std::vector<std::string>& files) {
  const bool names = message.starts_with("--") ||
                     std::any_of(files.begin(), files.end(),
                                 [&](const auto& file) { return message.find(file) != std::string::npos; });
  return names ? message : fmt::format("{}: {}", fmt::join(files, ", "), message);
}

/// Faults of the records and of the options are the user's to mend.
RecordFits fit_files(const std::vector<std::string>& files, const FitOptions& options) {
  std::vector<RecordSource> sources;
  for (const std::string& file : files) sources.push_back({.name = file});
  try {
    return fit_records(sources, options, scene::data_folders());
  } catch (const RecordError& error) {
    throw scene::InputError(with_name(error.what(), files));
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(with_name(error.what(), files));
  }
}

using Files = std::vector<std::pair<std::string, std::string>>;

/// What repeats the fit of these files.
std::string command_of(const Given& o, const std::vector<std::string>& files) {
  std::vector<std::string> texts = o.texts;
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (o.flags[i]) texts[i] = "given";
  return report::fit_command(files, texts);
}

/// The files of protocols; charts of one alone.
Files protocol_files(const RecordFits& fits, const Given& o) {
  const bool several = fits.protocols.size() > 1;
  Files files;
  for (std::size_t i = 0; i < fits.protocols.size(); ++i) {
    const auto& [record, reading] = fits.protocols[i];
    if (!several) files = report::protocol_chart_files(record, reading);
    const std::string number = several ? fmt::format("_{}", i + 1) : "", &file = o.data[i];
    files.emplace_back("sections" + number + ".csv", report::protocol_csv(reading));
    files.emplace_back("report" + number + ".html",
                       report::protocol_html(record, reading, file, command_of(o, {file})));
  }
  if (several)
    files.emplace_back("report.html", report::replicates_html(fits, o.data, command_of(o, o.data)));
  return files;
}

/// The files of a result, each a name and a text.
Files files_of(const RecordFits& fits, const Given& o) {
  const auto command = [&](const std::vector<std::string>& files) { return command_of(o, files); };
  if (!fits.protocols.empty()) return protocol_files(fits, o);
  const bool several = fits.fits.size() > 1;
  Files files = several ? Files{} : report::fit_chart_files(fits.fits.front(), fits.instrument);
  for (std::size_t i = 0; i < fits.fits.size(); ++i) {
    const std::string number = several ? fmt::format("_{}", i + 1) : "";
    files.emplace_back("fit" + number + ".csv", fit_csv(fits.fits[i]));
    files.emplace_back("report" + number + ".html",
                       report::fit_html(fits.fits[i], fits.instrument, o.data[i],
                                        command(several ? std::vector{o.data[i]} : o.data)));
  }
  if (several) files.emplace_back("report.html", report::replicates_html(fits, o.data, command(o.data)));
  return files;
}

/// Returns a note, or nothing.
std::string write_crate(const Given& o, const RecordFits& fits, const std::filesystem::path& folder) {
  report::Crate crate{.name = fmt::format("Fit of {}", fmt::join(o.data, ", ")),
                      .description = "parameters of the concrete from a rheometer's record",
                      .command = command_of(o, o.data)};
  for (const auto& reason : fits.reasons) crate.description += "; not to be trusted: " + reason;
  return report::write_crate(folder, crate);
}

int run_fit(const Given& o) {
  const Stopwatch watch;
  const FitOptions options = options_of(o);
  const std::string name = std::filesystem::path(o.data.front()).stem().string();
  const auto out =
      report::resolved_folder(o.out.empty() ? "runs/" + name : o.out);  // refuses before the work
  const RecordFits fits = fit_files(o.data, options);
  const Files files = files_of(fits, o);
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder(out, o.force, std::vector<std::filesystem::path>(o.data.begin(), o.data.end()));
  scene::Outcome outcome;
  outcome.apparatus = "fit";
  outcome.checks.reasons = fits.reasons;
  for (const auto& [file, text] : files) io::write_text(folder.staging() / file, text);
  watch.stop(outcome.cost);
  nlohmann::ordered_json summary = summary_of(outcome);
  summary["results"] = report::fit_results(fits, o.data);
  summary["input"] = report::fit_input(fits.options, o.data);
  io::write_text(folder.staging() / "summary.json", summary.dump(2) + "\n");
  const std::string note = o.crate ? write_crate(o, fits, folder.staging()) : "";
  folder.publish();
  if (!note.empty() && !o.quiet) say(stderr, "note: {}\n", note);
  for (const auto& reason : fits.reasons) say(stderr, "not to be trusted: {}\n", reason);
  if (o.json) {
    print_result_as_json(folder.target());
  } else if (!o.quiet) {
    print_fits(fits, o.data);
    say("{:<22} {}\n", "written to", folder.target().string());
  }
  return fits.reasons.empty() ? done : not_to_be_trusted;
}

void add_options(Command& command, Given& o) {
  for (std::size_t i = 0; i < fit_options().size(); ++i) {
    const FitOption& option = fit_options()[i];
    const std::string name = report::command_name(option);
    if (option.is_flag())
      command.flag(name.c_str(), o.flags[i], option.help);
    else if (!option.words.empty())
      command.choice(name.c_str(), o.texts[i], option.words, option.help);
    else
      command.option(name.c_str(), o.texts[i], option.help);
  }
}

}  // namespace

void add_command_fit(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<Given>();
  Command command(app, fit_command.name, fit_command.description);
  command.required("data", o->data,
                   "CSV or an instrument's export: speed and torque (flow curve), time and torque (decay), "
                   "or all three; several files are replicates, or, with --tribometer, fill heights");
  add_options(command, *o);
  add_crate_option(command, o->crate);
  add_json_option(command, o->json);
  command.option("--out", o->out, "Folder for the result (default: runs/<record's name>)");
  command.flag("--quiet", o->quiet, "Print nothing but errors");
  command.flag("--force", o->force, "Replace an earlier result in the folder");
  command.example("tremie fit torque.csv, with --speed \"0.25 rev/s\" --rest \"240 s\" for a torque decay");
  command.run([o, &exit_code] { exit_code = run_fit(*o); });
}

}  // namespace tremie::cli

// tremie study STUDY.toml: many runs of a scene, its keys changed by a design.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/own_file.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/study_folder.hpp"
#include "apparatus/cli/study/study_progress.hpp"
#include "apparatus/report/folder/own_files.hpp"
#include "apparatus/report/process.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/study/page/study_page.hpp"
#include "apparatus/study/rows/engines.hpp"
#include "apparatus/study/rows/files.hpp"
#include "apparatus/study/rows/pool.hpp"
#include "apparatus/study/rows/summary.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

namespace fs = std::filesystem;
using study::Definition;
using study::Design;
using study::Row;

struct StudyOptions {
  std::string file, out, engine;
  int jobs = 0;
  std::int64_t row = -1;
  bool resume = false, collect = false, submit = false, quiet = false, json = false, force = false;
};

/// All that a study's parts work on.
struct Job {
  Definition definition;
  Design design;
  fs::path folder;
  std::string fingerprint;
};

// --- rows -----------------------------------------------------------------------------------------------

constexpr char mend_mark = '!';  ///< before a message for the user, in place of a row

std::string run_as_text(const Job& job, std::size_t row) try {
  return study::row_json(
      study::run_row(job.definition, row, study::overrides_of(job.definition, job.design[row])));
} catch (const scene::InputError& error) {
  return mend_mark + std::string(error.what());
}

Row row_of(const Job& job, const study::Finished& finished) {
  if (!finished.text) return study::dead_row(job.definition.results.size(), finished.item, finished.death);
  if (finished.text->starts_with(mend_mark)) throw scene::InputError(finished.text->substr(1));
  const auto row = study::row_from_json(*finished.text, job.definition.results.size());
  return row ? *row : study::dead_row(job.definition.results.size(), finished.item, "cut off");
}

std::vector<std::size_t> rows_to_run(const Job& job, const std::vector<Row>& there) {
  std::vector<bool> known(job.design.size(), false);
  for (const Row& row : there)
    if (row.row < known.size()) known[row.row] = true;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i]) rows.push_back(i);
  return rows;
}

int jobs_of(const StudyOptions& options) {
  return options.jobs > 0 ? options.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// False where it was interrupted.
bool run_rows(const Job& job, const StudyOptions& options, study::Journal& journal,
              const std::vector<Row>& there) {
  const auto rows = rows_to_run(job, there);
  StudyProgress progress(job.design.size(), job.design.size() - rows.size(), options.quiet);
  return study::run_pool(
      rows, jobs_of(options), [&](std::size_t row) { return run_as_text(job, row); },
      [&](const study::Finished& finished) {
        const Row row = row_of(job, finished);
        journal.append(row);
        progress.row_done(row.exit_code == 0);
      },
      &stop_requested);
}

// --- the ways to run ------------------------------------------------------------------------------------

int finish(const Job& job, const StudyOptions& options, const study::RowFiles& files,
           const std::vector<Row>& journal, const Stopwatch& watch) {
  std::vector<Row> rows = journal;
  rows.insert(rows.end(), files.rows.begin(), files.rows.end());
  auto collected = study::collect(job.design.size(), std::move(rows));
  collected.problems.insert(collected.problems.end(), files.problems.begin(), files.problems.end());
  std::string note;
  const auto indices = study::sobol_indices(job.definition, job.design, collected, note);
  const auto reasons =
      study::write_results(job.definition, job.design, collected, indices, note, job.folder, watch);
  study::write_whole(job.folder / "report.html",
                     study::study_html(job.definition, job.design, collected, indices, note, reasons,
                                       "tremie study " + options.file));
  finish_study_folder(job.folder);
  for (const auto& reason : reasons) say(stderr, "not to be trusted: {}\n", reason);
  if (options.json) print_result_as_json(job.folder);
  if (!options.quiet) {
    if (const std::size_t moving = study::moving_rows(collected); moving > 0)
      say("note            in {} of {} runs the concrete still moved at the end (test.duration)\n", moving,
          collected.rows.size());
    say("written to      {}\n", job.folder.string());
  }
  return reasons.empty() ? done : not_to_be_trusted;
}

study::RowFiles row_files(const Job& job) {
  return study::read_row_files(job.folder, job.fingerprint, job.definition.results.size());
}

int run_here(const Job& job, const StudyOptions& options) {
  const Stopwatch watch;
  study::Journal journal(job.folder, job.fingerprint, job.definition.results.size());
  const auto files = row_files(job);
  std::vector<Row> there = journal.rows();
  there.insert(there.end(), files.rows.begin(), files.rows.end());
  stop_on_interrupt();
  if (!options.collect && !run_rows(job, options, journal, there)) {
    say(stderr, "interrupted; tremie study {} --out {} --resume goes on{}\n", options.file,
        job.folder.string(), where_the_earlier_is(job.folder));
    return interrupted;
  }
  return finish(job, options, files, journal.rows(), watch);
}

int run_one_row(const Job& job, const StudyOptions& options) {
  const auto index = static_cast<std::size_t>(options.row);
  if (index >= job.design.size())
    throw scene::InputError(
        fmt::format("--row {}: the design has the rows 0 to {}", index, job.design.size() - 1));
  for (const Row& row : row_files(job).rows)
    if (row.row == index && !options.force) return done;
  const Row row =
      study::run_row(job.definition, index, study::overrides_of(job.definition, job.design[index]));
  study::write_row_file(job.folder, job.fingerprint, row);
  for (const auto& reason : row.reasons) say(stderr, "row {} not to be trusted: {}\n", index, reason);
  return done;
}

int hand_to_engine(const Job& job, const StudyOptions& options) {
  const auto engine = options.engine == "slurm"       ? study::Engine::slurm
                      : options.engine == "snakemake" ? study::Engine::snakemake
                                                      : study::Engine::parallel;
  const auto script =
      study::engine_script(engine, own_file().parent_path() / "tremie", fs::absolute(options.file),
                           job.folder, job.design.size(), jobs_of(options));
  io::write_text(script.file, script.text);
  report::list_as_own(job.folder, {script.file.filename()});
  const std::string line = fmt::format("{}", fmt::join(script.start, " "));
  if (!options.submit) {
    if (!options.quiet) say("run             {}\n", line);
    return done;
  }
  const auto program = report::find_program(script.start.front());
  if (program.empty())
    throw scene::InputError(fmt::format("--submit: {} is not installed here; {} is written",
                                        script.start.front(), script.file.string()));
  const std::vector<std::string> arguments(script.start.begin() + 1, script.start.end());
  const auto code = report::run_program(program, arguments, job.folder, 1e9);
  if (code == 0) return done;
  say(stderr, "tremie study: {} ended with {}\n", line, code ? fmt::format("{}", *code) : "a signal");
  return code == not_to_be_trusted ? not_to_be_trusted : fault;
}

void check_together(const StudyOptions& options) {
  const int ways = (options.row >= 0) + options.collect + options.resume + !options.engine.empty();
  if (ways > 1)
    throw scene::InputError("--row, --collect, --resume and --engine: at most one of them at a time");
  if (options.submit && options.engine.empty()) throw scene::InputError("--submit: goes with --engine");
}

int run_study(const StudyOptions& options) {
  check_together(options);
  Job job;
  job.definition = study::read_definition(options.file);
  job.design = study::make_design(job.definition);
  job.folder = report::resolved_folder(options.out.empty() ? "runs/" + job.definition.name : options.out);
  job.fingerprint = study::fingerprint(job.definition, job.design);
  if (options.collect && !is_study_folder(job.folder)) report::refuse_folder(job.folder, "holds no study");
  const bool goes_on = options.resume || options.collect || options.row >= 0;
  make_study_folder(job.folder, goes_on, options.force);
  write_design(job.folder, study::design_csv(job.definition, job.design));
  if (options.row >= 0) return run_one_row(job, options);
  if (!options.engine.empty()) return hand_to_engine(job, options);
  return run_here(job, options);
}

}  // namespace

void add_command_study(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<StudyOptions>();
  Command command(app, study_command.name, study_command.description);
  command.required("study", o->file, "Study file (TOML): base, [[factor]], [design], [read]");
  command.option("--out", o->out, "Folder for the result (default: runs/<study's name>)");
  command.number("--jobs", o->jobs, 1, 4096,
                 "Runs at a time, one thread each (default: the machine's cores)");
  command.flag("--resume", o->resume, "Continue a study that was stopped or killed");
  command.number("--row", o->row, 0, 1000000, "Run one row alone (from 0), into DIR/rows");
  command.flag("--collect", o->collect, "Make study.csv of the finished rows; run none");
  command.choice("--engine", o->engine, {"slurm", "snakemake", "parallel"},
                 "Write what runs the rows elsewhere: slurm, snakemake, parallel");
  command.flag("--submit", o->submit, "Also start it");
  add_json_option(command, o->json);
  command.flag("--quiet", o->quiet, "Print nothing but errors");
  command.flag("--force", o->force, "Replace an earlier study in the folder");
  command.example(
      "tremie study study.toml, which names a base scene, each [[factor]] with its range, and [design] "
      "runs.");
  command.run([o, &exit_code] {
    o->quiet = o->quiet || o->json;
    exit_code = run_study(*o);
  });
}

}  // namespace tremie::cli

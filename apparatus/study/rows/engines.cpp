#include "apparatus/study/rows/engines.hpp"

#include <fmt/format.h>

namespace tremie::study {
namespace {

namespace fs = std::filesystem;

/// For a shell.
std::string quoted(const fs::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// A Python string.
std::string python(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string command(const fs::path& program, const fs::path& study, const fs::path& folder) {
  return fmt::format("{} study {} --out {}", quoted(program), quoted(study), quoted(folder));
}

/// An array's index is limited by a cluster's MaxArraySize, often 1001: each task runs a block of rows.
EngineScript slurm(const std::string& tremie, const fs::path& folder, std::size_t rows) {
  constexpr std::size_t most_tasks = 1000;
  const std::size_t block = (rows + most_tasks - 1) / most_tasks;
  const std::size_t tasks = (rows + block - 1) / block;
  const std::string text = fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=tremie-study\n"
      "#SBATCH --array=0-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --output=/dev/null\n"
      "# {} rows, {} a task. A row that is there already is not run again.\n"
      "row=$((SLURM_ARRAY_TASK_ID * {}))\n"
      "end=$((row + {}))\n"
      "while [ $row -lt $end ] && [ $row -lt {} ]; do\n"
      "  {} --row $row --quiet\n"
      "  row=$((row + 1))\n"
      "done\n",
      tasks - 1, rows, block, block, block, rows, tremie);
  const fs::path file = folder / "study.sbatch";
  return {file, text, {"sbatch", file.string()}, {}};
}

EngineScript snakemake(const std::string& tremie, const fs::path& folder, std::size_t rows, int jobs) {
  const std::string text = fmt::format(
      "# snakemake --snakefile Snakefile --directory . --cores {}\n"
      "TREMIE = {}\n"
      "rule collect:\n"
      "    input: expand(\"rows/{{row}}.json\", row=range({}))\n"
      "    output: \"study.csv\"\n"
      "    shell: \"{{TREMIE}} --collect --quiet || [ $? = 3 ]\"\n"
      "rule row:\n"
      "    output: \"rows/{{row}}.json\"\n"
      "    threads: 1\n"
      "    shell: \"{{TREMIE}} --row {{wildcards.row}} --quiet\"\n",
      jobs, python(tremie), rows);
  const fs::path file = folder / "Snakefile";
  return {file,
          text,
          {"snakemake", "--snakefile", file.string(), "--directory", folder.string(), "--cores",
           fmt::format("{}", jobs)},
          {}};
}

EngineScript parallel(const std::string& tremie, const fs::path& folder, std::size_t rows, int jobs) {
  const std::string text = fmt::format(
      "#!/bin/sh\n"
      "# Further machines: parallel's --sshloginfile. --resume-failed goes on after an interruption.\n"
      "seq 0 {} | parallel --jobs {} --joblog {} --resume-failed {} --row {{}} --quiet\n"
      "exec {} --collect\n",
      rows - 1, jobs, quoted(folder / "parallel.log"), tremie, tremie);
  const fs::path file = folder / "study.sh";
  return {file, text, {"sh", file.string()}, {}};
}

}  // namespace

EngineScript engine_script(Engine engine, const fs::path& program, const fs::path& study_file,
                           const fs::path& folder, std::size_t rows, int jobs) {
  const std::string tremie = command(program, study_file, folder);
  if (engine == Engine::slurm) return slurm(tremie, folder, rows);
  if (engine == Engine::snakemake) return snakemake(tremie, folder, rows, jobs);
  return parallel(tremie, folder, rows, jobs);
}

}  // namespace tremie::study

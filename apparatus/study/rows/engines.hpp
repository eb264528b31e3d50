#pragma once

// Past one machine: scripts by which Slurm, Snakemake or GNU parallel run the rows, each by
// `tremie study STUDY.toml --out DIR --row I`, and what collects them.

#include <filesystem>
#include <string>
#include <vector>

namespace tremie::study {

enum class Engine { slurm, snakemake, parallel };

struct EngineScript {
  std::filesystem::path file;  ///< in the study's folder
  std::string text;
  std::vector<std::string> start;    ///< program and arguments that run it
  std::vector<std::string> collect;  ///< program and arguments, where the script does not collect by itself
};

/// `program` and `study_file` as absolute paths, which every machine must see, as it must see `folder`.
EngineScript engine_script(Engine engine, const std::filesystem::path& program,
                           const std::filesystem::path& study_file, const std::filesystem::path& folder,
                           std::size_t rows, int jobs);

}  // namespace tremie::study

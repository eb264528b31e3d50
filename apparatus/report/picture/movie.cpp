#include "apparatus/report/picture/movie.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "apparatus/report/picture/draw.hpp"
#include "apparatus/report/process.hpp"

namespace tremie::picture {
namespace {

namespace fs = std::filesystem;

constexpr double still_at_the_end = 2.0;  ///< the last frame stays for so long [s]
constexpr double encoding_limit = 600.0;  ///< [s]

struct TimedFrame {
  double time;
  fs::path file;
};

/// The frames that frames.pvd names.
std::vector<TimedFrame> frames_of(const fs::path& folder) {
  std::ifstream stream(folder / "frames.pvd");
  if (!stream) throw std::runtime_error((folder / "frames.pvd").string() + ": cannot be read");
  static const std::regex entry("timestep=\"([^\"]+)\".*file=\"([^\"]+)\"");
  std::vector<TimedFrame> frames;
  std::smatch found;
  for (std::string line; std::getline(stream, line);)
    if (std::regex_search(line, found, entry))
      frames.push_back({std::stod(found[1]), folder / found[2].str()});
  if (frames.size() < 2)
    throw std::runtime_error(folder.string() +
                             ": has one frame; run the scene with --set output.frames=true for all of them");
  return frames;
}

/// Whether the scene is a slump flow's section; throws for another apparatus.
bool is_section(const fs::path& folder) {
  std::ifstream stream(folder / "scene.toml");
  std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (!std::regex_search(text, std::regex("apparatus *= *\"slump_flow\"")))
    throw std::runtime_error(folder.string() + ": no run of a slump flow, which alone has a movie");
  return std::regex_search(text, std::regex("space *= *\"axisymmetric\""));
}

/// A folder for the single pictures, gone when it is done with.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("tremie-movie-" + std::to_string(getpid()));
  Scratch() { fs::create_directory(path); }
  ~Scratch() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

/// Draws all frames on one plate and one scale of colours; returns ffmpeg's list of them with their durations.
fs::path draw_all(const std::vector<TimedFrame>& frames, bool section, const fs::path& folder) {
  View view{.axisymmetric = section};
  double low = 1e300, high = -1e300;
  for (const TimedFrame& f : frames) {
    const Loaded loaded = load(f.file.string());
    low = std::min(low, loaded.low), high = std::max(high, loaded.high);
    view.plate = std::max(view.plate, plate_of(loaded));
  }
  view.range = {low, high};
  std::string list;
  char text[96];
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::snprintf(text, sizeof text, "frame_%05zu.png", i);
    view.frame = frames[i].file.string(), view.out = (folder / text).string();
    list += std::string("file '") + text + "'\n";
    const double lasts = i + 1 < frames.size() ? frames[i + 1].time - frames[i].time : still_at_the_end;
    std::snprintf(text, sizeof text, "%.2f s", frames[i].time);
    view.caption = text;
    draw(view);
    std::snprintf(text, sizeof text, "duration %.4f\n", lasts);
    list += text;
  }
  std::snprintf(text, sizeof text, "file 'frame_%05zu.png'\n",
                frames.size() - 1);  // or its duration is not used
  const fs::path file = folder / "list.txt";
  std::ofstream(file) << list << text;
  return file;
}

std::vector<std::string> encoding(const fs::path& out) {
  if (out.extension() == ".gif")
    return {"-vf", "fps=12,scale=900:-1,split[a][b];[a]palettegen[p];[b][p]paletteuse"};
  return {"-vf", "fps=25", "-pix_fmt", "yuv420p", "-movflags", "+faststart"};
}

}  // namespace

void make_movie(const fs::path& folder, const fs::path& out) {
  if (out.extension() != ".mp4" && out.extension() != ".gif")
    throw std::runtime_error(out.string() + ": a movie ends with .mp4 or .gif");
  const auto frames = frames_of(folder);
  const bool section = is_section(folder);
  const fs::path ffmpeg = report::find_program("ffmpeg");
  if (ffmpeg.empty()) throw std::runtime_error("ffmpeg is not installed here: no movie");
  const Scratch scratch;
  const fs::path list = draw_all(frames, section, scratch.path),
                 made = scratch.path / ("movie" + out.extension().string());
  std::vector<std::string> arguments{"-y", "-f", "concat", "-i", list.string()};
  for (const std::string& word : encoding(out)) arguments.push_back(word);
  arguments.push_back(made.string());
  if (report::run_program(ffmpeg, arguments, scratch.path, encoding_limit) != 0)
    throw std::runtime_error("ffmpeg failed: no movie");
  const fs::path beside = out.string() + ".part";
  std::error_code error;
  fs::copy_file(made, beside, fs::copy_options::overwrite_existing, error);
  if (!error) fs::rename(beside, out, error);
  if (error) {
    const std::string why = error.message();
    fs::remove(beside, error);
    throw std::runtime_error(out.string() + ": cannot be written: " + why);
  }
}

}  // namespace tremie::picture

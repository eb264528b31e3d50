#pragma once

#include <filesystem>

namespace tremie::picture {

/// A slump flow's frames as a movie (.mp4, .gif), at the pace of the test. `folder`: what `tremie run` left, with all
/// frames. Needs ffmpeg. Throws std::runtime_error with what is missing; a movie that broke off is removed.
void make_movie(const std::filesystem::path& folder, const std::filesystem::path& out);

}  // namespace tremie::picture

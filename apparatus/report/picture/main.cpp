// tremie-picture FRAME.vtp OUT.png [--axisymmetric] [--spread MM]: the final shape on its plate, seen
// obliquely, coloured by the flocculation state, or by the shear rate where there is none.
// tremie-picture DIR --movie [OUT.mp4|OUT.gif]: all frames of a slump flow; DIR/movie.mp4 where no file is named.
// A program of its own, so that a run without pictures loads no VTK. Needs a display: VTK is built for GLX here.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include "apparatus/report/picture/draw.hpp"
#include "apparatus/report/picture/movie.hpp"

namespace tremie::picture {
namespace {

struct Options {
  View view;
  std::string movie;  ///< empty: one picture
};

Options parse(int argc, char** argv) {
  Options options;
  View& view = options.view;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--axisymmetric")
      view.axisymmetric = true;
    else if (word == "--spread" && i + 1 < argc)
      view.spread_mm = std::atof(argv[++i]);
    else if (word == "--movie")
      options.movie = i + 1 < argc ? argv[++i] : view.frame + "/movie.mp4";
    else if (view.frame.empty())
      view.frame = word;
    else
      view.out = word;
  }
  if (view.frame.empty() || view.out.empty() == options.movie.empty())
    throw std::invalid_argument(
        "usage: tremie-picture FRAME.vtp OUT.png [--axisymmetric] [--spread MM]\n"
        "       tremie-picture DIR --movie [OUT.mp4|OUT.gif]");
  return options;
}

}  // namespace
}  // namespace tremie::picture

int main(int argc, char** argv) {
  try {
    const auto options = tremie::picture::parse(argc, argv);
    if (options.movie.empty())
      tremie::picture::draw(options.view);
    else
      tremie::picture::make_movie(options.view.frame, options.movie);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "tremie-picture: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tremie-picture: %s\n", error.what());
    return 1;
  }
}

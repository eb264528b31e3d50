#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/page/page.hpp"
#include "apparatus/report/page/shapes.hpp"

namespace tremie::report {
namespace {

constexpr double width = 480, reach = 150, top = 34;
using Colour = std::array<double, 3>;

/// The moving picture's colours.
constexpr std::array<Colour, 5> stops{
    {{0, 103, 165}, {90, 130, 165}, {165, 150, 130}, {225, 150, 60}, {250, 170, 20}}};

std::string colour_at(double share) {
  const double s = 4.0 * std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0);
  const auto k = std::min<std::size_t>(3, static_cast<std::size_t>(s));
  const double f = s - static_cast<double>(k);
  const auto part = [&](std::size_t j) {
    return std::lround(stops[k][j] + f * (stops[k + 1][j] - stops[k][j]));
  };
  return fmt::format("rgb({},{},{})", part(0), part(1), part(2));
}

std::string circle(double r, const std::string& how) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.2f}\" {}/>", 0.5 * width, top + reach, r,
                     how);
}

std::string scale_svg(const Disc& disc, double y) {
  std::string text;
  constexpr int pieces = 44;
  for (int i = 0; i < pieces; ++i)
    text += fmt::format(
        "<rect fill=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"5.6\" height=\"10\" "
        "shape-rendering=\"crispEdges\"/>",
        colour_at((i + 0.5) / pieces), 130.0 + 5.0 * i, y);
  return text +
         fmt::format(
             "<text x=\"124\" y=\"{0:.1f}\" text-anchor=\"end\">{1:.2g}</text><text x=\"356\" "
             "y=\"{0:.1f}\">{2:.2g}</text><text x=\"240\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>",
             y + 11, disc.low, disc.high, y + 30, escaped(disc.words));
}

}  // namespace

std::string disc_svg(const Disc& disc) {
  const std::size_t n = std::min(disc.radius.size(), disc.values.size());
  if (n < 2) return {};
  const double scale = reach / disc.radius[n - 1];
  std::string rings;
  for (std::size_t i = n; i-- > 1;) {  // from the outside in, each over the one before
    const double value = std::max(0.5 * (disc.values[i] + disc.values[i - 1]), disc.low);
    rings += circle(
        scale * disc.radius[i],
        fmt::format("fill=\"{}\"", colour_at(std::log(value / disc.low) / std::log(disc.high / disc.low))));
  }
  if (disc.solids.empty()) rings += circle(scale * disc.radius[0], "class=\"hole\" fill=\"#fff\"");
  for (const Polyline& solid : disc.solids) {
    std::string path;
    for (const auto& p : solid)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", 0.5 * width + scale * p[0],
                          top + reach - scale * p[1]);
    rings += "<path class=\"solid\" fill=\"#1c2126\" d=\"" + path + "z\"/>";
  }
  for (const double r : {disc.radius[0], disc.radius[n - 1]})
    rings += circle(scale * r, "class=\"wall\" fill=\"none\" stroke=\"#1c2126\" stroke-width=\"2\"");
  const double end = top + 2 * reach;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" role=\"img\" aria-label=\"{2}\" "
      "font-family=\"sans-serif\" font-size=\"15\" fill=\"#1c2126\"><text x=\"{3}\" y=\"18\" "
      "text-anchor=\"middle\">{2}</text>{4}<text x=\"{3}\" y=\"{5:.0f}\" text-anchor=\"middle\">from above; "
      "shown from {6:.1f} to {7:.1f} mm</text>{8}</svg>\n",
      width, end + 76, escaped(disc.title), 0.5 * width, rings, end + 20, 1e3 * disc.radius[0],
      1e3 * disc.radius[n - 1], scale_svg(disc, end + 32));
}

}  // namespace tremie::report

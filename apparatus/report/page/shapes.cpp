#include "apparatus/report/page/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/page.hpp"

namespace tremie::report {
namespace {

constexpr double width = 480, margin = 16;

struct Box {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  void include(double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
};

Box box_of(const Shape& shape) {
  Box box;
  for (const auto& p : shape.places) box.include(p[0], p[1]);
  for (const Polyline& wall : shape.walls)
    for (const auto& p : wall) box.include(p[0], p[1]);
  if (box.x0 > box.x1) box = {0.0, 0.1, 0.0, 0.1};
  if (shape.mirrored) {
    const double r =
        std::max({std::abs(box.x0), std::abs(box.x1), 0.5 * shape.ring_diameter, 0.5 * shape.plan_diameter});
    box.x0 = -r, box.x1 = r;
  }
  return box;
}

/// A bitmap of the section, its gaps between points closed: grown by `reach` cells and shrunk again.
class Bitmap {
 public:
  Bitmap(const Box& box, double cell, int reach)
      : box_(box),
        cell_(cell),
        reach_(reach),
        nx_(static_cast<int>((box.x1 - box.x0) / cell) + 2 * reach + 3),
        ny_(static_cast<int>((box.y1 - box.y0) / cell) + 2 * reach + 3),
        on_(static_cast<std::size_t>(nx_ * ny_), 0) {}

  void mark(double x, double y) {
    const int i = static_cast<int>((x - box_.x0) / cell_) + reach_ + 1,
              j = static_cast<int>((y - box_.y0) / cell_) + reach_ + 1;
    if (i >= 0 && j >= 0 && i < nx_ && j < ny_) on_[index(i, j)] = 1;
  }
  void close() {
    for (const char value : {char{1}, char{0}})
      for (const bool along_x : {true, false}) spread(value, along_x);
  }
  /// Rows of the body as (x, y, length) of runs [m].
  template <class Use>
  void runs(Use use) const {
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        if (!on_[index(i, j)]) continue;
        const int first = i;
        while (i < nx_ && on_[index(i, j)]) ++i;
        use(box_.x0 + (first - reach_ - 1) * cell_, box_.y0 + (j - reach_ - 1) * cell_, (i - first) * cell_);
      }
  }

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j * nx_ + i); }
  /// Cells within reach of one that has the value get it.
  void spread(char value, bool along_x) {
    std::vector<char> result = on_;
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        if (on_[index(i, j)] != value) continue;
        for (int k = -reach_; k <= reach_; ++k) {
          const int a = along_x ? i + k : i, b = along_x ? j : j + k;
          if (a >= 0 && b >= 0 && a < nx_ && b < ny_) result[index(a, b)] = value;
        }
      }
    on_ = std::move(result);
  }

  Box box_;
  double cell_;
  int reach_, nx_, ny_;
  std::vector<char> on_;
};

/// Metres to the paper; y upwards in the section.
struct Paper {
  double scale, x0, y1, top;
  double x(double v) const { return margin + (v - x0) * scale; }
  double y(double v) const { return top + (y1 - v) * scale; }
};

std::string section_path(const Shape& shape, const Box& box, const Paper& paper) {
  const double cell = std::max(0.5 * shape.point_size, (box.x1 - box.x0) / 320);
  Bitmap bitmap(box, cell, static_cast<int>(std::ceil(2.2 * shape.point_size / cell)));
  for (const auto& p : shape.places) {
    bitmap.mark(p[0], p[1]);
    if (shape.mirrored) bitmap.mark(-p[0], p[1]);
  }
  bitmap.close();
  std::string path;
  bitmap.runs([&](double x, double y, double length) {
    path += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.2f}h{:.1f}z", paper.x(x), paper.y(y), length * paper.scale,
                        -cell * paper.scale - 0.15, -length * paper.scale);
  });
  return "<path class=\"body\" fill=\"#0067a5\" d=\"" + path + "\"/>";
}

std::string wall_svg(const Polyline& wall, const Paper& paper, double sign) {
  std::string path;
  for (const auto& p : wall)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", paper.x(sign * p[0]), paper.y(p[1]));
  return "<path class=\"wall\" fill=\"none\" stroke=\"#1c2126\" stroke-width=\"2\" d=\"" + path + "\"/>";
}

std::string centred(double x, double y, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x, y, escaped(text));
}

std::string plan_svg(const Shape& shape, double middle, double scale, double top) {
  const double r = 0.5 * shape.plan_diameter * scale, R = std::max(r, 0.5 * shape.ring_diameter * scale);
  std::string text =
      fmt::format("<circle class=\"body\" fill=\"#0067a5\" cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"{2:.1f}\"/>",
                  middle, top + R, r);
  if (shape.ring_diameter > 0.0)
    text += fmt::format(
        "<circle class=\"level\" fill=\"none\" stroke=\"#1c2126\" stroke-width=\"1.6\" stroke-dasharray=\"6 "
        "4\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>",
        middle, top + R, 0.5 * shape.ring_diameter * scale);
  const std::string ring = shape.ring_diameter > 0.0
                               ? fmt::format("; dashed: the {:.0f} mm circle", 1e3 * shape.ring_diameter)
                               : "";
  return text + centred(middle, top + 2 * R + 20,
                        fmt::format("from above, {:.0f} mm across{}", 1e3 * shape.plan_diameter, ring));
}

}  // namespace

std::string shape_svg(const Shape& shape) {
  const Box box = box_of(shape);
  const double largest = shape.plan_diameter > 0.0 ? 0.62 : 1.0;  // a plan needs its height too
  const double scale =
      std::min(largest * (width - 2 * margin) / (box.x1 - box.x0), 300.0 / std::max(box.y1 - box.y0, 1e-6));
  const double pad = 0.5 * (width - 2 * margin) - 0.5 * (box.x1 - box.x0) * scale;
  const Paper paper{scale, box.x0 - pad / scale, box.y1, 34};
  const double section_end = paper.y(box.y0);
  double tall = 0.0;
  for (const auto& p : shape.places) tall = std::max(tall, p[1]);
  std::string text = centred(0.5 * width, 18, shape.title);
  text += section_path(shape, box, paper);
  for (const Polyline& wall : shape.walls) {
    text += wall_svg(wall, paper, 1.0);
    if (shape.mirrored) text += wall_svg(wall, paper, -1.0);
  }

  text += fmt::format(
      "<line class=\"wall\" stroke=\"#1c2126\" stroke-width=\"2\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" "
      "y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>",
      paper.x(box.x0), paper.x(box.x1), section_end + 1);
  // What clings to a wall is no height of the body.
  text += centred(0.5 * width, section_end + 20,
                  shape.walls.empty()
                      ? fmt::format("section, true proportions; {:.0f} mm at its highest", 1e3 * tall)
                      : "section, true proportions");
  double end = section_end + 32;
  if (shape.plan_diameter > 0.0) {
    text += plan_svg(shape, 0.5 * width, scale, end);
    end += std::max(shape.plan_diameter, shape.ring_diameter) * scale + 30;
  }
  return svg_element(shape.title, width, std::nearbyint(end), "", text);
}

}  // namespace tremie::report

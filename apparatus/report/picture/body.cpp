#include "apparatus/report/picture/body.hpp"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tremie::picture {
namespace {

constexpr int columns = 96;   ///< of the section, axis to front
constexpr int layers = 16;    ///< of the section, floor to surface
constexpr int sectors = 144;  ///< of the three quarters of a turn
constexpr double turn = 1.5 * std::numbers::pi;

/// A meridian section as a structured mesh: r[i], z = height[i] * j / layers, field[i][j].
struct Section {
  std::vector<double> r, height;
  std::vector<std::vector<double>> field;
};

/// Height of the surface over each column: the highest point near it, smoothed over its neighbours.
std::vector<double> surface(const Cloud& cloud, double front) {
  std::vector<double> top(columns, 0.0);
  for (const auto& p : cloud.points) {
    const double at = std::hypot(p[0], p[1]) / front * columns;
    const int i = std::min(static_cast<int>(at), columns - 1);
    auto& column = top[static_cast<std::size_t>(i)];
    column = std::max(column, p[2]);
  }
  for (std::size_t i = 1; i < top.size(); ++i)
    if (top[i] == 0.0) top[i] = top[i - 1];
  std::vector<double> smooth(columns + 1, 0.0);
  for (int i = 0; i < columns; ++i) {
    const int low = std::max(i - 2, 0), high = std::min(i + 2, columns - 1);
    double sum = 0.0;
    for (int k = low; k <= high; ++k) sum += top[static_cast<std::size_t>(k)];
    smooth[static_cast<std::size_t>(i)] = sum / (high - low + 1);
  }
  return smooth;  // ends on the floor, at the front
}

/// The field at (r, z): the nearest points' mean, distances measured in shares of the local thickness.
double field_at(const Cloud& cloud, double r, double z, double thickness, double front) {
  const double across = front / columns, up = std::max(thickness / layers, 1e-6);
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& p = cloud.points[i];
    const double dr = (std::hypot(p[0], p[1]) - r) / across, dz = (p[2] - z) / up;
    const double d2 = dr * dr + dz * dz + 0.05;
    const double weight = 1.0 / (d2 * d2 * d2);
    sum += weight * cloud.field[i];
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

Section section_of(const Cloud& cloud) {
  Section section;
  const double front = radius(cloud);
  section.height = surface(cloud, front);
  for (int i = 0; i <= columns; ++i) {
    const double r = front * i / columns, height = section.height[static_cast<std::size_t>(i)];
    section.r.push_back(r);
    auto& field = section.field.emplace_back();
    for (int j = 0; j <= layers; ++j) field.push_back(field_at(cloud, r, height * j / layers, height, front));
  }
  return section;
}

/// Gathers points and quads.
class Mesh {
 public:
  vtkIdType add(double x, double y, double z, double value) {
    field_->InsertNextValue(value);
    return points_->InsertNextPoint(x, y, z);
  }

  /// A sheet of (m + 1) x (n + 1) points, each from point(i, j).
  template <class Point>
  void sheet(int m, int n, Point point) {
    const vtkIdType first = points_->GetNumberOfPoints();
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j) point(i, j);
    const auto at = [&](int i, int j) { return first + static_cast<vtkIdType>(i) * (n + 1) + j; };
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) {
        const std::array<vtkIdType, 4> quad{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        cells_->InsertNextCell(4, quad.data());
      }
    }
  }

  vtkSmartPointer<vtkPolyData> finish(bool vertices) {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points_);
    if (!vertices) data->SetPolys(cells_);
    field_->SetName("field");
    data->GetPointData()->SetScalars(field_);
    return data;
  }

 private:
  vtkSmartPointer<vtkPoints> points_ = vtkSmartPointer<vtkPoints>::New();
  vtkSmartPointer<vtkCellArray> cells_ = vtkSmartPointer<vtkCellArray>::New();
  vtkSmartPointer<vtkDoubleArray> field_ = vtkSmartPointer<vtkDoubleArray>::New();
};

}  // namespace

double radius(const Cloud& cloud) {
  double largest = 1e-6;
  for (const auto& p : cloud.points) largest = std::max(largest, std::hypot(p[0], p[1]));
  return largest;
}

vtkSmartPointer<vtkPolyData> revolve(const Cloud& cloud) {
  const Section s = section_of(cloud);
  const auto value = [&](int i, int j) {
    return s.field[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  };
  const auto r = [&](int i) { return s.r[static_cast<std::size_t>(i)]; };
  const auto height = [&](int i) { return s.height[static_cast<std::size_t>(i)]; };
  Mesh mesh;
  mesh.sheet(columns, sectors, [&](int i, int k) {
    const double angle = turn * k / sectors;
    mesh.add(r(i) * std::cos(angle), r(i) * std::sin(angle), height(i), value(i, layers));
  });
  for (const double angle : {0.0, turn}) {
    mesh.sheet(columns, layers, [&](int i, int j) {
      mesh.add(r(i) * std::cos(angle), r(i) * std::sin(angle), height(i) * j / layers, value(i, j));
    });
  }
  return mesh.finish(false);
}

vtkSmartPointer<vtkPolyData> section_edge(const Cloud& cloud) {
  const double front = radius(cloud);
  const std::vector<double> height = surface(cloud, front);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(2 * columns + 1);
  for (int i = -columns; i <= columns; ++i) {
    const double angle = i < 0 ? 0.0 : turn, r = front * std::abs(i) / columns;
    const double z = height[static_cast<std::size_t>(std::abs(i))];
    lines->InsertCellPoint(points->InsertNextPoint(r * std::cos(angle), r * std::sin(angle), z + 6e-4));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

vtkSmartPointer<vtkPolyData> as_points(const Cloud& cloud) {
  Mesh mesh;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    mesh.add(cloud.points[i][0], cloud.points[i][1], cloud.points[i][2], cloud.field[i]);
  return mesh.finish(true);
}

}  // namespace tremie::picture

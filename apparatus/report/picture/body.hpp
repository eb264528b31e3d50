#pragma once

// From material points to something to look at: a field on a meridian section, and the body of revolution
// that it makes.

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

namespace tremie::picture {

/// The points of one frame and the field that colours them.
struct Cloud {
  std::vector<std::array<double, 3>> points;  ///< [m]
  std::vector<double> field;
};

/// The body that points in the plane (r, 0, z) stand for, revolved about z by three quarters of a turn: the
/// last quarter is left open, so that the section shows. The field is the point data "field".
vtkSmartPointer<vtkPolyData> revolve(const Cloud& cloud);

/// The edge between the surface and the two cut faces of revolve(), as one line.
vtkSmartPointer<vtkPolyData> section_edge(const Cloud& cloud);

/// Points as they are, with the field.
vtkSmartPointer<vtkPolyData> as_points(const Cloud& cloud);

/// The largest distance from the axis [m].
double radius(const Cloud& cloud);

}  // namespace tremie::picture

#include "apparatus/report/picture/draw.hpp"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkDataArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLight.h>
#include <vtkLineSource.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

namespace tremie::picture {
namespace {

constexpr double open_towards_camera = -45.0;  ///< turns the open quarter of revolve() [degrees]

/// Viridis: even in brightness, readable without colour vision and in print.
vtkSmartPointer<vtkLookupTable> colours(double low, double high) {
  constexpr std::array<std::array<double, 3>, 5> viridis{{{0.267, 0.005, 0.329},
                                                          {0.230, 0.322, 0.546},
                                                          {0.128, 0.567, 0.551},
                                                          {0.369, 0.789, 0.383},
                                                          {0.993, 0.906, 0.144}}};
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int n = 256;
  table->SetNumberOfTableValues(n);
  for (int i = 0; i < n; ++i) {
    const double x = 4.0 * i / (n - 1);
    const auto k = static_cast<std::size_t>(std::min(x, 3.999));
    const double t = x - static_cast<double>(k);
    const auto mix = [&](std::size_t c) { return viridis[k][c] * (1 - t) + viridis[k + 1][c] * t; };
    table->SetTableValue(i, mix(0), mix(1), mix(2));
  }
  table->SetRange(low, high);
  table->Build();
  return table;
}

vtkSmartPointer<vtkActor> body_actor(const Loaded& loaded, vtkLookupTable* table, bool axisymmetric) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  vtkSmartPointer<vtkMapper> mapper;
  if (axisymmetric) {
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(revolve(loaded.cloud));
    normals->ConsistencyOff();
    auto surface = vtkSmartPointer<vtkPolyDataMapper>::New();
    surface->SetInputConnection(normals->GetOutputPort());
    mapper = surface;
  } else {
    vtkNew<vtkSphereSource> ball;
    ball->SetRadius(0.004);  // ten pixels wide: six sides look round
    ball->SetThetaResolution(6), ball->SetPhiResolution(6);
    auto balls = vtkSmartPointer<vtkGlyph3DMapper>::New();
    balls->SetInputData(as_points(loaded.cloud));
    balls->SetSourceConnection(ball->GetOutputPort());
    balls->ScalingOff();
    mapper = balls;
  }
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
  actor->SetMapper(mapper);
  // Mostly ambient: the colours must read as on the bar.
  actor->GetProperty()->SetAmbient(0.65);
  actor->GetProperty()->SetDiffuse(0.45);
  actor->RotateZ(open_towards_camera);
  return actor;
}

/// Surfaces or lines of one colour, without light and shade.
vtkSmartPointer<vtkActor> flat_actor(vtkPolyDataMapper* mapper, double red, double green, double blue,
                                     float line_width = 1) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(red, green, blue);
  actor->GetProperty()->SetLineWidth(line_width);
  actor->GetProperty()->LightingOff();
  return actor;
}

/// The same of what a source makes.
void add_flat(vtkRenderer& renderer, vtkAlgorithm* source, double red, double green, double blue,
              float line_width = 1) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  renderer.AddActor(flat_actor(mapper, red, green, blue, line_width));
}

/// A thin line around the cut, which the colours alone do not show.
vtkSmartPointer<vtkActor> edge_actor(const Cloud& cloud) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(section_edge(cloud));
  mapper->ScalarVisibilityOff();
  auto actor = flat_actor(mapper, 1, 1, 1, 1.5F);
  actor->RotateZ(open_towards_camera);
  return actor;
}

void add_plate(vtkRenderer& renderer, double side) {
  vtkNew<vtkPlaneSource> plate;
  plate->SetOrigin(-side / 2, -side / 2, -0.001);
  plate->SetPoint1(side / 2, -side / 2, -0.001);
  plate->SetPoint2(-side / 2, side / 2, -0.001);
  add_flat(renderer, plate, 0.90, 0.91, 0.92);
}

/// The circles of 200 and 500 mm that the standard's plate carries.
void add_circle(vtkRenderer& renderer, double r) {
  vtkNew<vtkRegularPolygonSource> circle;
  circle->SetNumberOfSides(180);
  circle->SetRadius(r);
  circle->GeneratePolygonOff();
  circle->SetCenter(0, 0, 0.0002);
  add_flat(renderer, circle, 0.55, 0.57, 0.6, 2);
}

void add_line(vtkRenderer& renderer, std::array<double, 3> a, std::array<double, 3> b) {
  vtkNew<vtkLineSource> line;
  line->SetPoint1(a.data());
  line->SetPoint2(b.data());
  add_flat(renderer, line, 0.15, 0.15, 0.15, 2.5F);
}

/// Text in front of everything, its top centre at a place of the scene.
vtkSmartPointer<vtkTextActor> add_text(vtkRenderer& renderer, const std::string& text,
                                       std::array<double, 3> at, int size) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(text.c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToWorld();
  actor->GetPositionCoordinate()->SetValue(at.data());
  actor->GetTextProperty()->SetFontSize(size);
  actor->GetTextProperty()->SetColor(0.15, 0.15, 0.15);
  actor->GetTextProperty()->SetJustificationToCentered();
  actor->GetTextProperty()->SetVerticalJustificationToTop();
  renderer.AddActor2D(actor);
  return actor;
}

/// The spread as a dimension line in front of the body.
void add_spread(vtkRenderer& renderer, double spread_mm, double plate) {
  const double r = spread_mm / 2000.0, y = -plate / 2 + 0.07, tick = 0.012;
  add_line(renderer, {-r, y, 0}, {r, y, 0});
  for (const double x : {-r, r}) add_line(renderer, {x, y - tick, 0}, {x, y + tick, 0});
  char text[64];
  std::snprintf(text, sizeof text, "%.0f mm", spread_mm);
  add_text(renderer, text, {0, y - 0.015, 0}, 34);
}

void add_colour_bar(vtkRenderer& renderer, vtkLookupTable* table, const std::string& title) {
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(table);
  bar->SetNumberOfLabels(4);
  bar->SetLabelFormat("%-#.3g");
  bar->SetOrientationToHorizontal();
  bar->SetTextPositionToPrecedeScalarBar();
  bar->SetTextPad(8);
  bar->SetPosition(0.32, 0.83);
  bar->SetWidth(0.36);
  bar->SetHeight(0.09);
  bar->UnconstrainedFontSizeOn();
  vtkTextProperty* labels = bar->GetLabelTextProperty();
  labels->SetColor(0.15, 0.15, 0.15);
  labels->SetFontSize(26);
  labels->ItalicOff();
  labels->BoldOff();
  labels->ShadowOff();
  renderer.AddActor2D(bar);
  const auto heading = add_text(renderer, title, {0.5, 0.975, 0}, 28);
  heading->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
}

void add_caption(vtkRenderer& renderer, const std::string& text) {
  add_text(renderer, text, {0.5, 0.12, 0}, 34)
      ->GetPositionCoordinate()
      ->SetCoordinateSystemToNormalizedViewport();
}

void aim(vtkRenderer& renderer, double plate) {
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(0, 0.02 * plate, 0);
  camera->SetPosition(0, -1.9 * plate, 1.15 * plate);
  camera->SetViewUp(0, 0, 1);
  camera->SetViewAngle(24);
  renderer.ResetCameraClippingRange();
}

void write_png(vtkRenderWindow* window, const std::string& file) {
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace

Loaded load(const std::string& file) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  vtkDataArray* field = data->GetPointData()->GetArray("flocculation");
  Loaded loaded;
  loaded.title = field ? "flocculation" : "shear rate, 1/s";
  if (!field) field = data->GetPointData()->GetArray("shear_rate");
  if (!field || data->GetNumberOfPoints() == 0)
    throw std::runtime_error(file + ": no points with a field to colour by");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    const double* p = data->GetPoint(i);
    loaded.cloud.points.push_back({p[0], p[1], p[2]});
    loaded.cloud.field.push_back(field->GetTuple1(i));
  }
  const auto [low, high] = std::minmax_element(loaded.cloud.field.begin(), loaded.cloud.field.end());
  loaded.low = *low;
  loaded.high = *high > *low ? *high : *low + 1e-9;
  return loaded;
}

double plate_of(const Loaded& loaded) { return std::max(0.7, 2.5 * radius(loaded.cloud)); }

void draw(const View& view) {
  const Loaded loaded = load(view.frame);
  const auto [low, high] = view.range.value_or(std::pair{loaded.low, loaded.high});
  const auto table = colours(low, high);
  const double plate = view.plate > 0.0 ? view.plate : plate_of(loaded);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  add_plate(*renderer, plate);
  for (const double r : {0.1, 0.25}) add_circle(*renderer, r);
  renderer->AddActor(body_actor(loaded, table, view.axisymmetric));
  if (view.axisymmetric) renderer->AddActor(edge_actor(loaded.cloud));
  if (view.spread_mm > 0.0) add_spread(*renderer, view.spread_mm, plate);
  if (!view.caption.empty()) add_caption(*renderer, view.caption);
  add_colour_bar(*renderer, table, loaded.title);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(1400, 900);
  window->SetMultiSamples(
      0);  // rendered by software, eight samples a pixel cost three times as much as all the rest
  renderer->UseFXAAOn();
  window->AddRenderer(renderer);
  aim(*renderer, plate);
  window->Render();
  write_png(window, view.out);
}

}  // namespace tremie::picture

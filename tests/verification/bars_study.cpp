// Two ways to take a thin bar's drag, error against run time: by its drag law on cells as large as the bar, and by points
// on its surface that hold the velocity, on cells that resolve it. Prints the table of bars.md.

#include <fmt/format.h>
#include <omp.h>

#include <ctime>

#include "apparatus/verification/references/bodies.hpp"

namespace {

using namespace tremie;

constexpr double mu = 30.0, diameter = 0.012, speed = 1e-4, spacing = 0.0707, reach = 0.113;

struct Drag {
  double force, cpu_s;  ///< over mu U, a metre of bar; [s]
  bool converged;
};

/// A row of bars, `cells` of them from one to the next, between planes of symmetry; the bars move at U through concrete
/// that stands still.
ImplicitBody<PlaneStrain> row(int cells, double Bi) {
  const double h = spacing / cells;
  const std::array n{2 * static_cast<int>(std::lround(reach / h)), cells};
  ImplicitBody<PlaneStrain> body;
  body.mix = bodies::concrete(Bi * mu * speed / diameter, mu);
  body.mix.density = 1.0;  // creeping flow
  for (int d = 0; d < 2; ++d)
    body.grid.axes[d] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = n[d]};
  seed_box<PlaneStrain>(
      Vec<2>::Zero(), Vec<2>(h * n[0], spacing), {2 * n[0], 2 * n[1]}, 1.0, body.mix.K,
      [](const auto&) { return true; }, [](const auto&) { return 0.0; }, body.points);
  return body;
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

StepSettings creeping() {
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.particle_shifting.on = false;
  settings.admm.tolerance = 1e-4, settings.admm.max_iterations = 20000;
  return settings;
}

Drag by_law(int cells, double Bi) {
  ImplicitBody<PlaneStrain> body = row(cells, Bi);
  add_bar(body.grid.axes, {reach, 0.5 * spacing}, diameter, body.bars);
  for (auto& point : body.bars) point.velocity[0] = speed;
  const double start = seconds();
  const bool converged = implicit_step(body, ExactBingham{}, creeping()).converged;
  const double cpu_s = seconds() - start;
  double force = 0.0;
  for (const auto& bar : body.bar_drag) force -= bar_force<2>(bar, body.grid.cell_nodes, body.v)[0];
  return {force / (mu * speed), cpu_s, converged};
}

Drag resolved(int cells, double Bi) {
  ImplicitBody<PlaneStrain> body = row(cells, Bi);
  const double h = spacing / cells;
  const int n = 2 * static_cast<int>(std::ceil(std::numbers::pi * diameter / h));  // two points a cell
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / n;
    body.boundary.push_back(
        {.x = {reach + 0.5 * diameter * std::cos(angle), 0.5 * spacing + 0.5 * diameter * std::sin(angle)},
         .velocity = {speed, 0.0}});
  }
  StepSettings settings = creeping();
  // A thousand times the viscous stiffness of a cell.
  settings.boundary_stiffness = 1e3 * mu * *settings.fixed_dt / (body.mix.density * h * h);
  const double start = seconds();
  const bool converged = implicit_step(body, ExactBingham{}, settings).converged;
  const double cpu_s = seconds() - start;
  double force = 0.0;
  for (const auto& point : body.bound) force += wall_force<2>(point, body.grid.cell_nodes, body.v)[0];
  return {force / (mu * speed), cpu_s, converged};
}

void print(const char* way, int cells, double Bi, double expected, const Drag& drag) {
  const double over = Bi > 0.0 ? Bi : 1.0;
  fmt::print("| {:g} | {} | {:.2f} | {:.2f} | {:.2f} | {:+.1f} % | {:.2f} |{}\n", Bi, way,
             1e3 * spacing / cells, drag.force / over, expected, 100.0 * (drag.force / over / expected - 1.0),
             drag.cpu_s, drag.converged ? "" : " not converged |");
  std::fflush(stdout);
}

}  // namespace

int main() {
  omp_set_num_threads(1);
  fmt::print("| Bi | way | cells mm | drag | expected | error | CPU s |\n|---|---|---|---|---|---|---|\n");
  // Tamada and Fujikawa at Bi = 0; Rheolef's finite elements; the limit load of Randolph and Houlsby.
  for (const auto& [Bi, expected] :
       {std::array{0.0, 10.90}, {1.0, 28.2}, {10.0, 15.8}, {100.0, 13.0}, {1000.0, 11.94}}) {
    for (int cells : {5, 7, 10}) print("law", cells, Bi, expected, by_law(cells, Bi));
    for (int cells : {24, 48, 72}) print("resolved", cells, Bi, expected, resolved(cells, Bi));
  }
}

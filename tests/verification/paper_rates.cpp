// How much of the paper's shear rates is in how they are taken: a mix in the paper's scheme, its mean shear
// rate by several definitions in the same flow, at the peak and summed up over time; spread and lambda at the
// end.
//
//   paper_rates [cell in mm] [rest in s] [seconds] [share of FLIP; 0: APIC] [mix: 0, 1, 2 for A, B, C]
//               [1: shear rates are not halved in the law either] [alpha] [gate in 1/s]

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>
#include <map>

#include "apparatus/slump_flow/explicit_run.hpp"
#include "libmpm/transfer/tile_sums.hpp"

namespace tremie {

/// Geometry for a law that takes engineering shear rates for components of D: simple shear at the rate g yields,
/// flows and breaks lambda down as if at 2 g; extension is as it should be.
struct Unhalved : ThreeD {};

template <>
inline void strain_rate_of<Unhalved, f64x8>(const f64x8 (&L)[3][3], const f64x8& v_0, const f64x8& x_0,
                                            f64x8 (&q)[5], f64x8& divergence) {
  strain_rate_of<ThreeD, f64x8>(L, v_0, x_0, q, divergence);
  for (int k = 2; k < 5; ++k) q[k] *= 2.0;
}

}  // namespace tremie

namespace tremie::slump_flow {
namespace {

constexpr int D = 3;
struct PaperMix {
  double tau_0, mu, A_thix, friction;
};
constexpr PaperMix mixes[] = {{54.0, 35.8, 1.3, 0.35}, {61.0, 29.0, 1.8, 0.45}, {130.0, 30.2, 2.9, 0.43}};

struct Asked {
  double cell, rest, seconds, flip;
  PaperMix mix;
  double alpha, gate;
};

enum Definition {
  volume_mean,
  point_mean,
  root_mean_square,
  unhalved,
  own_affine,
  linear_elements,
  definitions
};
constexpr const char* names[definitions] = {"mean over volume, GIMP (what a run reports)",
                                            "mean over points, GIMP",
                                            "root mean square over volume",
                                            "engineering shear rates not halved",
                                            "points' affine velocity",
                                            "linear elements, points' velocities"};
using Rates = std::array<double, definitions>;

Scene paper_scene(const Asked& asked) {
  Scene scene;
  const PaperMix& mix = asked.mix;
  scene.mix.tau_0 = mix.tau_0, scene.mix.mu = mix.mu, scene.mix.K = 1e4 / (3.0 * (1.0 - 2.0 * 0.45));
  scene.mix.thixotropy = Thixotropy{mix.A_thix, asked.alpha};
  scene.mix.thixotropy->kinetics = Kinetics::gated;
  scene.mix.thixotropy->gamma_c = asked.gate;
  scene.floor = {ContactKind::friction, mix.friction};
  scene.rest = asked.rest;
  Model& m = scene.model;
  m.space = SpaceKind::quarter, m.law = Papanastasiou{5.0};
  m.scheme = SchemeKind::explicit_usf, m.shape = ShapeKind::gimp, m.time_step = 1e-4;
  m.cell = {asked.cell, asked.cell}, m.points_per_cell = {2, 2};
  if (asked.flip > 0.0) m.transfer = TransferKind::flip, m.flip_blend = asked.flip;
  return scene;
}

/// sqrt(2 D:D), its shear components taken `shear` times.
double rate_of(const Mat<D, D>& L, double shear) {
  double sum = 0.0;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      const double d = 0.5 * (L(a, b) + L(b, a)) * (a == b ? 1.0 : shear);
      sum += 2.0 * d * d;
    }
  return std::sqrt(sum);
}

/// Velocities of the points on linear elements, and their gradient at x.
class LinearElements {
 public:
  LinearElements(const Points<D>& points, double h) : h_(h) {
    for (std::size_t p = 0; p < points.size(); ++p)
      at_corners(points.x[p], [&](const Index<D>& i, double N, const Vec<D>&) {
        auto& node = nodes_.try_emplace(i, 0.0, Vec<D>::Zero()).first->second;
        node.first += N * points.mass[p], node.second += N * points.mass[p] * points.v[p];
      });
    for (auto& [i, node] : nodes_) {
      if (node.first > 0.0) node.second /= node.first;
      for (int d = 0; d < 2; ++d)
        if (i[d] == 0) node.second[d] = 0.0;  // planes of symmetry
      if (i[2] == 0) node.second[2] = 0.0;
    }
  }
  Mat<D, D> gradient(const Vec<D>& x) const {
    Mat<D, D> L = Mat<D, D>::Zero();
    at_corners(
        x, [&](const Index<D>& i, double, const Vec<D>& dN) { L += nodes_.at(i).second * dN.transpose(); });
    return L;
  }

 private:
  template <class Visit>
  void at_corners(const Vec<D>& x, Visit visit) const {
    for (int k = 0; k < 8; ++k) {
      Index<D> i;
      Vec<D> N, dN;
      for (int d = 0; d < D; ++d) {
        const int cell = static_cast<int>(std::floor(x[d] / h_)), up = k >> d & 1;
        const double s = x[d] / h_ - cell;
        i[d] = cell + up, N[d] = up ? s : 1.0 - s, dN[d] = (up ? 1.0 : -1.0) / h_;
      }
      visit(i, N.prod(), Vec<D>(dN[0] * N[1] * N[2], N[0] * dN[1] * N[2], N[0] * N[1] * dN[2]));
    }
  }
  double h_;
  std::map<Index<D>, std::pair<double, Vec<D>>> nodes_;
};

/// L of every point from the velocities on the grid.
template <class Geometry>
void gradients(ExplicitState<Geometry>& state, std::vector<Mat<D, D>>& L) {
  for (int t = 0; t < state.grid.n_tiles(); ++t) {
    const Tile<D>& tile = state.grid.tiles[static_cast<std::size_t>(t)];
    NodeCube<double, D> v;
    read_blocks<double, D>(tile, state.grid.v, v);
    for (int g = tile.first_group; g < tile.last_group; ++g) {
      const auto group = static_cast<std::size_t>(g);
      Weights<double, D> weights;
      AtPoints<double, D, 1> at;
      weigh<double, D>({state.grid.axes, state.shape, tile.at}, places_of<D>(state.points, group), weights);
      gather<double, D, 1>(v, weights, {weights.dw}, at);
      for (int l = 0; l < filled<D>(state.points, group); ++l)
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b)
            L[static_cast<std::size_t>(state.points.id[group][static_cast<std::size_t>(l)])](a, b) =
                at.along[0][b][a][l];
    }
  }
}

template <class Geometry>
Rates rates_of(const Body<Geometry>& body, const std::vector<Mat<D, D>>& L) {
  Rates r{};
  const LinearElements elements(body.points, body.grid.axes[0].h);
  double volume = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double V = body.points.volume(p), rate = rate_of(L[p], 1.0);
    volume += V;
    r[volume_mean] += V * rate, r[root_mean_square] += V * rate * rate;
    r[point_mean] += rate / static_cast<double>(body.points.size());
    r[unhalved] += V * rate_of(L[p], 2.0);
    r[own_affine] += V * rate_of(body.points.C[p], 1.0);
    r[linear_elements] += V * rate_of(elements.gradient(body.points.x[p]), 1.0);
  }
  for (const Definition d : {volume_mean, root_mean_square, unhalved, own_affine, linear_elements})
    r[d] /= volume;
  r[root_mean_square] = std::sqrt(r[root_mean_square]);
  return r;
}

template <class Geometry>
void print_rates(const Asked& asked) {
  const auto [cell, rest, seconds, flip, mix, alpha, gate] = asked;
  const Scene scene = paper_scene(asked);
  Body<Geometry> body = filled_cone<Geometry>(scene);
  ExplicitSettings settings = explicit_settings(scene);
  settings.keep_affine = true;
  RigidWall<D> wall;
  lifted_wall(scene, settings.wall_gap + 0.6 * cell, wall);
  const Papanastasiou law{scene.model.regularisation};
  auto state = start_explicit(body, law, settings, shape_of<Geometry>(scene.model));
  std::vector<Mat<D, D>> L(state.points.n);
  Rates peak{}, total{};
  constexpr double interval = 0.01;
  while (body.time < seconds - 1e-9) {
    for (int i = 0; i < 100; ++i) explicit_step(body, law, settings, state, wall);
    write_back(state, body);
    if (rim_height(scene, body.time) > 0.35) wall = {};
    gradients(state, L);
    const Rates now = rates_of(body, L);
    for (int d = 0; d < definitions; ++d) peak[d] = std::max(peak[d], now[d]), total[d] += interval * now[d];
  }
  fmt::print("| {:.0f} mm cells, rest {:.0f} s, {} s, {} | peak 1/s | summed up over time |\n|---|---|---|\n",
             1e3 * cell, rest, seconds, flip > 0.0 ? "FLIP" : "APIC");
  for (int d = 0; d < definitions; ++d) fmt::print("| {} | {:.2f} | {:.2f} |\n", names[d], peak[d], total[d]);
  fmt::print("\nspread {:.1f} mm, lambda {:.2f}\n", 1e3 * spread_of(scene, body.points),
             test_run::mean_flocculation(body.points).value_or(0.0));
}

}  // namespace
}  // namespace tremie::slump_flow

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  const auto value = [&](int i, double fallback) { return i < argc ? std::atof(argv[i]) : fallback; };
  const tremie::slump_flow::Asked asked{.cell = 1e-3 * value(1, 20.0),
                                        .rest = value(2, 0.0),
                                        .seconds = value(3, 1.0),
                                        .flip = value(4, 0.0),
                                        .mix = tremie::slump_flow::mixes[static_cast<int>(value(5, 0))],
                                        .alpha = value(7, 0.01),
                                        .gate = value(8, 0.1)};
  if (value(6, 0.0) > 0.0)
    tremie::slump_flow::print_rates<tremie::Unhalved>(asked);
  else
    tremie::slump_flow::print_rates<tremie::ThreeD>(asked);
}

#include <cstdio>
#include <ctime>
#include "apparatus/icar_vane/icar_vane.hpp"
#include <gtest/gtest.h>
#include <cstdlib>
using namespace tremie; using namespace tremie::icar_vane;
TEST(X, Y) {
  Scene s; s.model.space = SpaceKind::cylindrical;
  const auto e=[](const char*n,double d){const char*v=std::getenv(n);return v?atof(v):d;};
  const double h=e("H",0.009); s.model.cell={h,e("A",h)}; s.mix.tau_0=e("T",0); s.mix.mu=e("MU",35.8); s.speed=e("S",0.25); s.duration=5;
  s.vane.radius=e("R",.0635); s.vane.height=e("HT",.127); s.vane.container_radius=e("RC",.143); s.vane.bottom_gap=e("G",.0795); s.vane.cover=e("C",.0795);s.vane.shaft_radius=e("SH",.01);
  s.vane.blades=int(e("B",4)); s.vane.blade_thickness=e("BT",0.003); s.threads=int(e("TH",1));
  const clock_t c=clock(); const Outcome o=run(s);
  std::printf("cells %ld it %d torque %.6f wall %.6f power %.6f plane %.6f factor %.4f cpu %.1f\n",(long)o.cost.cells_active,o.series.back().iterations,o.results.torque_end,o.results.torque_wall_end,o.results.torque_power_end,*o.results.torque_plane,*o.results.end_factor,double(clock()-c)/CLOCKS_PER_SEC);
  for (auto&r:o.checks.reasons) std::printf("reason %s\n",r.c_str());
}

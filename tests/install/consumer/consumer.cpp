// A vane's torque by Reiner-Riwlin, and a scene run in process.

#include <cstdio>

#include "apparatus/registry/registry.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

int main() {
  const double torque = tremie::reiner_riwlin({.tau_0 = 54.0, .mu = 35.8}, tremie::angular_speed(0.5)).torque;
  auto scene =
      tremie::scene::read_text("apparatus = 'slump_flow'\nmix = 'mix_c'\ntest.duration = '0.2 s'", "scene");
  const auto outcome = tremie::scene::run(scene);
  std::printf("torque_N_m %.6f\n%s\n", torque, outcome.lines.front().c_str());
}

#include "tools/bench/kinematics_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#include "models/excavator/collision_model.hpp"
#include "models/excavator/machine_model.hpp"
#include "models/types/cpu_clock.hpp"

namespace wex {
namespace {

constexpr int kRuns = 3;             // the machine is shared: the quietest run counts
constexpr int kSamples = 500;        // per run
constexpr int kCallsPerSample = 50;  // the clock itself costs about 0.3 us

struct Percentiles {
  double least, median, p90, p99;
};

Percentiles time_us(const std::function<void()>& call) {
  std::vector<double> best;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> samples(kSamples);
    for (double& sample : samples) {
      const double start_s = thread_cpu_time_s();
      for (int i = 0; i < kCallsPerSample; ++i) call();
      sample = (thread_cpu_time_s() - start_s) / kCallsPerSample * 1e6;
    }
    std::sort(samples.begin(), samples.end());
    if (best.empty() || samples[kSamples / 2] < best[kSamples / 2]) best = std::move(samples);
  }
  return {best.front(), best[kSamples / 2], best[kSamples * 9 / 10], best[kSamples * 99 / 100]};
}

void print(const char* what, const Percentiles& us) {
  std::printf("%-34s %8.3f %8.3f %8.3f %8.3f\n", what, us.least, us.median, us.p90, us.p99);
}

/// Over many postures: how much is near what decides the time.
void bench_collision(const MachineModel& machine, double& sum) {
  const CollisionModel collision = CollisionModel::build(machine);
  constexpr int kPostures = 200;
  constexpr double kMargin_m = 0.10;
  std::mt19937 generator(2);
  std::vector<KinematicTree::Workspace> postures(kPostures, machine.tree.make_workspace());
  for (KinematicTree::Workspace& posture : postures) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
    for (int i = 0; i < machine.num_joints(); ++i) {
      const Joint& joint = machine.joints[i];
      std::uniform_real_distribution<double> within(std::max(joint.lower, -3.0),
                                                    std::min(joint.upper, 3.0));
      q[kNumBaseCoordinates + i] = within(generator);
    }
    machine.tree.update(q, posture);
  }
  std::size_t next = 0;
  const auto posture = [&]() -> const KinematicTree::Workspace& {
    return postures[next++ % postures.size()];
  };
  Eigen::VectorXd gradient(machine.num_coordinates());
  std::printf("%zu capsules, %zu pairs; random postures\n", collision.capsules().size(),
              collision.pairs().size());
  print("nearest of all pairs", time_us([&] { sum += collision.nearest(posture()).distance_m; }));
  print("clear by 0.10 m", time_us([&] { sum += collision.clear(posture(), kMargin_m); }));
  print("arm clear by 0.10 m",
        time_us([&] { sum += collision.clear(posture(), CollisionModel::Part::kArm, kMargin_m); }));
  print("one distance with gradient", time_us([&] {
          const CollisionModel::Pair& pair = collision.pairs()[next * 7 % collision.pairs().size()];
          sum += collision.distance(machine.tree, posture(), pair, gradient);
        }));
}

}  // namespace

int bench_kinematics() {
  const auto machine = load_machine("m545");
  if (!machine) {
    std::fprintf(stderr, "%s\n", machine.error().message.c_str());
    return 2;
  }
  const KinematicTree& tree = machine->tree;
  const int n = machine->num_coordinates();
  auto w = tree.make_workspace();
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> angle(-0.5, 0.5);
  Eigen::VectorXd q(n);
  for (double& value : q) value = angle(generator);
  tree.update(q, w);

  Eigen::Matrix3Xd jacobian(3, n);
  Eigen::MatrixXd hessian(n, n);
  const Eigen::Vector3d weights(0.3, -0.5, 0.8);
  const WheeledLeg& leg = machine->legs[static_cast<int>(Limb::kLF)];
  double sum = 0.0;  // printed, so that no result can be optimised away
  const auto keep = [&](double value) { sum += value; };

  std::printf("chain kinematics, %d coordinates, %zu bodies; us per call, thread CPU time\n", n,
              tree.bodies().size());
  std::printf("%-34s %8s %8s %8s %8s\n", "", "min", "p50", "p90", "p99");
  print("update (all bodies and CoM)", time_us([&] {
          q[kNumBaseCoordinates] += 1e-6;
          tree.update(q, w);
          keep(w.p_world_base.x());
        }));
  print("4 wheel positions", time_us([&] {
          for (const WheeledLeg& each : machine->legs) {
            keep(tree.position(w, each.carrier_body, each.p_carrier_wheel).z());
          }
        }));
  print("4 wheel Jacobians", time_us([&] {
          for (const WheeledLeg& each : machine->legs) {
            tree.position_jacobian(w, each.carrier_body, each.p_carrier_wheel, jacobian);
            keep(jacobian(2, 3));
          }
        }));
  print("4 axle direction Jacobians", time_us([&] {
          for (const WheeledLeg& each : machine->legs) {
            tree.direction_jacobian(w, each.carrier_body, each.axle_carrier, jacobian);
            keep(jacobian(2, 3));
          }
        }));
  print("CoM Jacobian", time_us([&] {
          tree.com_jacobian(w, jacobian);
          keep(jacobian(2, 3));
        }));
  print("1 wheel Hessian", time_us([&] {
          tree.position_hessian(w, leg.carrier_body, leg.p_carrier_wheel, weights, hessian);
          keep(hessian(3, 3));
        }));
  print("1 axle direction Hessian", time_us([&] {
          tree.direction_hessian(w, leg.carrier_body, leg.axle_carrier, weights, hessian);
          keep(hessian(3, 3));
        }));
  print("CoM Hessian", time_us([&] {
          tree.com_hessian(w, weights, hessian);
          keep(hessian(3, 3));
        }));
  bench_collision(*machine, sum);
  std::printf("check sum %g\n", sum);
  return 0;
}

}  // namespace wex

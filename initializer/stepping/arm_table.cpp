#include "initializer/stepping/arm_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace wex {
namespace {

using Complex = std::complex<double>;

// Grid of contact places in the arm's plane.
constexpr double kNearest_m = 2.8, kFarthest_m = 8.6, kForwardStep_m = 0.1;
constexpr double kLowest_m = -4.2, kHighest_m = 1.4, kUpStep_m = 0.1;
const int kNumForward = static_cast<int>(std::lround((kFarthest_m - kNearest_m) / kForwardStep_m));
const int kNumUp = static_cast<int>(std::lround((kHighest_m - kLowest_m) / kUpStep_m));

constexpr double kMaxAttitude_rad = std::numbers::pi / 4.0;
constexpr std::size_t kNumAttitudes = 7;
constexpr int kNumTelescopes = 5;
// The exact posture is computed for a place up to half a cell away from the table's.
constexpr double kLimitMargin_rad = 0.05, kReachMargin_m = 0.08;

constexpr int kNumYaws = 24, kNumReaches = 6;
constexpr double kCounterWeightClear_m = 0.3;  // lowest point, above the base origin

Complex turned(double angle_rad) { return std::polar(1.0, angle_rad); }

bool within(double value, const ArmPlane::Limits& limits, double margin) {
  return value >= limits.lower + margin && value <= limits.upper - margin;
}

}  // namespace

std::optional<ArmPlane> ArmPlane::of(const MachineModel& machine) {
  constexpr double kTolerance = 1e-9;
  constexpr std::size_t kNumArmJoints = 5;
  if (!machine.arm || machine.arm->coordinates.size() < kNumArmJoints) return std::nullopt;
  const KinematicTree& tree = machine.tree;
  std::array<int, kNumArmJoints> coordinate{}, body{};
  std::array<const Joint*, kNumArmJoints> joint{};
  Eigen::VectorXd q = Eigen::VectorXd::Zero(machine.num_coordinates());
  q.tail(machine.num_joints()) = machine.transport_posture();
  for (std::size_t i = 0; i < kNumArmJoints; ++i) {
    coordinate[i] = machine.arm->coordinates[i];
    joint[i] = &machine.joints[static_cast<std::size_t>(coordinate[i] - kNumBaseCoordinates)];
    body[i] = joint[i]->body;
    q[coordinate[i]] = 0.0;
  }
  const bool prismatic_as_expected = !joint[0]->prismatic && !joint[1]->prismatic &&
                                     !joint[2]->prismatic && joint[3]->prismatic &&
                                     !joint[4]->prismatic;
  if (!prismatic_as_expected) return std::nullopt;

  KinematicTree::Workspace w = tree.make_workspace();
  tree.update(q, w);
  const auto axis = [&](std::size_t i) { return w.axis_world[static_cast<std::size_t>(body[i])]; };
  const auto hinge = [&](std::size_t i) {
    return w.p_world_joint[static_cast<std::size_t>(body[i])];
  };
  const auto mass = [&](std::size_t i) {
    return w.subtree_mass_kg[static_cast<std::size_t>(body[i])];
  };
  const auto moment = [&](std::size_t i) {
    return w.subtree_mass_times_com[static_cast<std::size_t>(body[i])];
  };
  const bool turns_about_base_z = (axis(0) - Eigen::Vector3d::UnitZ()).norm() < kTolerance &&
                                  hinge(0).head<2>().norm() < kTolerance;
  if (!turns_about_base_z) return std::nullopt;
  for (const std::size_t i : {1U, 2U, 4U}) {
    if (std::abs(std::abs(axis(i).y()) - 1.0) > kTolerance) return std::nullopt;
  }
  if (std::abs(axis(3).y()) > kTolerance) return std::nullopt;
  const auto in_plane = [](const Eigen::Vector3d& v) { return Complex(v.x(), v.z()); };
  // A turn about -y takes x to z.
  const auto sign = [&](std::size_t i) { return axis(i).y() < 0.0 ? 1.0 : -1.0; };
  const auto lever = [&](std::size_t i) {
    return in_plane(moment(i)) - mass(i) * in_plane(hinge(i));
  };

  ArmPlane plane;
  const Eigen::Vector3d p_contact =
      tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact);
  plane.lateral_m_ = p_contact.y();
  plane.boom_hinge_ = in_plane(hinge(1));
  plane.boom_link_ = in_plane(hinge(2)) - in_plane(hinge(1));
  plane.dipper_link_ = in_plane(hinge(4)) - in_plane(hinge(2));
  plane.tele_axis_ = in_plane(axis(3));
  plane.bucket_link_ = in_plane(p_contact) - in_plane(hinge(4));
  plane.boom_length_m_ = std::abs(plane.boom_link_);
  plane.bucket_length_m_ = std::abs(plane.bucket_link_);
  plane.bucket_moment_ = lever(4);
  plane.dipper_moment_ = lever(2) - lever(4);
  plane.boom_moment_ = lever(1) - lever(2);
  plane.boom_sign_ = sign(1);
  plane.dipper_sign_ = sign(2);
  plane.bucket_sign_ = sign(4);
  plane.arm_mass_kg_ = mass(1);
  plane.tele_mass_kg_ = mass(3);
  plane.moment_cabin_ = moment(0);
  plane.moment_cabin_.x() -= moment(1).x();
  plane.moment_cabin_.z() -= moment(1).z();
  plane.boom_ = {joint[1]->lower, joint[1]->upper};
  plane.dipper_ = {joint[2]->lower, joint[2]->upper};
  plane.tele_ = {joint[3]->lower, joint[3]->upper};
  plane.ee_pitch_ = {joint[4]->lower, joint[4]->upper};

  // The plane must say what the tree says, at a posture with every joint moved.
  const ArmPosture probe{0.7, 0.3, -0.4, 0.5, -0.6};
  const std::array<double, kNumArmJoints> values{probe.turn_rad, probe.boom_rad, probe.dipper_rad,
                                                 probe.tele_m, probe.ee_pitch_rad};
  for (std::size_t i = 0; i < kNumArmJoints; ++i) q[coordinate[i]] = values[i];
  tree.update(q, w);
  const Points points = plane.points(probe);
  const double c = std::cos(probe.turn_rad), s = std::sin(probe.turn_rad);
  constexpr double kAgree = 1e-6;
  const bool agrees =
      (plane.p_base(points.contact, c, s) -
       tree.position(w, machine.arm->contact_body, machine.arm->p_body_contact))
              .norm() < kAgree &&
      (plane.moment_base(points.moment, c, s) - moment(0)).norm() < kAgree * machine.total_mass_kg;
  if (!agrees) return std::nullopt;
  return plane;
}

ArmPlane::Points ArmPlane::points(const ArmPosture& posture) const noexcept {
  const Complex boom = turned(boom_sign_ * posture.boom_rad);
  const Complex dipper = boom * turned(dipper_sign_ * posture.dipper_rad);
  const Complex bucket = dipper * turned(bucket_sign_ * posture.ee_pitch_rad);
  Points points;
  points.elbow = boom_hinge_ + boom * boom_link_;
  points.wrist = points.elbow + dipper * (dipper_link_ + posture.tele_m * tele_axis_);
  points.contact = points.wrist + bucket * bucket_link_;
  points.moment = arm_mass_kg_ * boom_hinge_ + boom * boom_moment_ +
                  dipper * (dipper_moment_ + posture.tele_m * tele_mass_kg_ * tele_axis_) +
                  bucket * bucket_moment_;
  return points;
}

std::optional<ArmPosture> ArmPlane::reach(Complex contact, double tele_m, double attitude_rad,
                                          double limit_margin_rad,
                                          double reach_margin_m) const noexcept {
  if (!within(tele_m, tele_, 0.0)) return std::nullopt;
  return reach(contact, tele_m, Complex(std::sin(attitude_rad), -std::cos(attitude_rad)),
               limit_margin_rad, reach_margin_m);
}

// Only the joint angles themselves need an arc tangent each.
std::optional<ArmPosture> ArmPlane::reach(Complex contact, double tele_m, Complex edge_direction,
                                          double limit_margin_rad,
                                          double reach_margin_m) const noexcept {
  const auto times = [](Complex a, Complex b) {
    return Complex(a.real() * b.real() - a.imag() * b.imag(),
                   a.real() * b.imag() + a.imag() * b.real());
  };
  const auto angle = [](Complex c) { return std::atan2(c.imag(), c.real()); };
  const Complex wrist = contact - bucket_length_m_ * edge_direction - boom_hinge_;
  const Complex dipper_link = dipper_link_ + tele_m * tele_axis_;
  const double dipper_square = std::norm(dipper_link), square = std::norm(wrist);
  const double dipper_length = std::sqrt(dipper_square);
  const double farthest = boom_length_m_ + dipper_length - reach_margin_m;
  const double nearest = std::abs(boom_length_m_ - dipper_length) + reach_margin_m + 1e-9;
  if (square > farthest * farthest || square < nearest * nearest) return std::nullopt;
  const double cosine_scaled = 0.5 * (boom_length_m_ * boom_length_m_ + square - dipper_square);
  const double sine_scaled = std::sqrt(
      std::max(0.0, boom_length_m_ * boom_length_m_ * square - cosine_scaled * cosine_scaled));
  // Unit vectors of turned links against the links at zero.
  const Complex boom = times(times(wrist, {cosine_scaled, sine_scaled}), std::conj(boom_link_)) /
                       (square * boom_length_m_ * boom_length_m_);
  ArmPosture posture;
  posture.tele_m = tele_m;
  posture.boom_rad = boom_sign_ * angle(boom);
  if (!within(posture.boom_rad, boom_, limit_margin_rad)) return std::nullopt;
  const Complex forearm = wrist - times(boom, boom_link_);
  const Complex dipper = times(forearm, std::conj(dipper_link)) / dipper_square;  // from the base
  posture.dipper_rad = dipper_sign_ * angle(times(dipper, std::conj(boom)));
  if (!within(posture.dipper_rad, dipper_, limit_margin_rad)) return std::nullopt;
  posture.ee_pitch_rad =
      bucket_sign_ * angle(times(edge_direction, std::conj(times(dipper, bucket_link_))));
  if (!within(posture.ee_pitch_rad, ee_pitch_, limit_margin_rad)) return std::nullopt;
  return posture;
}

std::optional<ArmPlane::InPlane> ArmPlane::in_plane(const Eigen::Vector3d& p_base) const noexcept {
  const double square = p_base.head<2>().squaredNorm() - lateral_m_ * lateral_m_;
  if (square < 1.0) return std::nullopt;
  const double forward = std::sqrt(square);
  return InPlane{std::atan2(p_base.y(), p_base.x()) - std::atan2(lateral_m_, forward),
                 {forward, p_base.z()}};
}

ArmTable::ArmTable(const ArmPlane& plane) : plane_(plane) {
  first_.reserve(static_cast<std::size_t>(kNumForward) * kNumUp + 1);
  first_.push_back(0);
  std::vector<Posture> candidates;
  std::array<double, kNumAttitudes> attitudes_rad;
  std::array<Complex, kNumAttitudes> edge_directions;
  for (std::size_t a = 0; a < kNumAttitudes; ++a) {
    attitudes_rad[a] = std::lerp(-kMaxAttitude_rad, kMaxAttitude_rad,
                                 static_cast<double>(a) / (kNumAttitudes - 1));
    edge_directions[a] = Complex(std::sin(attitudes_rad[a]), -std::cos(attitudes_rad[a]));
  }
  for (int i = 0; i < kNumForward; ++i) {
    for (int j = 0; j < kNumUp; ++j) {
      const Complex contact(kNearest_m + kForwardStep_m * i, kLowest_m + kUpStep_m * j);
      candidates.clear();
      for (int t = 0; t < kNumTelescopes; ++t) {
        const double tele_m =
            std::lerp(plane.tele().lower + kLimitMargin_rad, plane.tele().upper - kLimitMargin_rad,
                      static_cast<double>(t) / (kNumTelescopes - 1));
        for (std::size_t a = 0; a < kNumAttitudes; ++a) {
          const auto posture =
              plane.reach(contact, tele_m, edge_directions[a], kLimitMargin_rad, kReachMargin_m);
          if (!posture) continue;
          const ArmPlane::Points p = plane.points(*posture);
          candidates.push_back(
              {static_cast<float>(p.moment.real()), static_cast<float>(p.moment.imag()),
               static_cast<float>(p.elbow.real()), static_cast<float>(p.elbow.imag()),
               static_cast<float>(p.wrist.real()), static_cast<float>(p.wrist.imag()),
               static_cast<float>(tele_m), static_cast<float>(attitudes_rad[a])});
        }
      }
      std::sort(candidates.begin(), candidates.end(), [](const Posture& a, const Posture& b) {
        return a.moment_forward < b.moment_forward;
      });
      const int n = static_cast<int>(candidates.size());
      const int kept = std::min(n, kMaxPostures);
      for (int k = 0; k < kept; ++k) {
        const int from = kept == n ? k : k * (n - 1) / (kept - 1);
        postures_.push_back(candidates[static_cast<std::size_t>(from)]);
      }
      if (n > 0) max_reach_m_ = std::max(max_reach_m_, contact.real());
      first_.push_back(static_cast<std::int32_t>(postures_.size()));
    }
  }
}

ArmTable::Span ArmTable::postures(Complex contact) const noexcept {
  const int i = static_cast<int>(std::floor((contact.real() - kNearest_m) / kForwardStep_m + 0.5));
  const int j = static_cast<int>(std::floor((contact.imag() - kLowest_m) / kUpStep_m + 0.5));
  if (i < 0 || j < 0 || i >= kNumForward || j >= kNumUp) return {};
  const std::size_t cell = static_cast<std::size_t>(i) * kNumUp + j;
  return {postures_.data() + first_[cell], postures_.data() + first_[cell + 1]};
}

std::vector<CounterWeight> make_counter_weights(const MachineModel& machine,
                                                const ArmPlane& plane) {
  const Eigen::VectorXd transport = machine.transport_posture();
  const auto value = [&](std::size_t i) {
    return transport[machine.arm->coordinates[i] - kNumBaseCoordinates];
  };
  const ArmPosture folded{0.0, value(1), value(2), value(3), value(4)};
  constexpr int kSteps = 6;
  const auto grid = [](const ArmPlane::Limits& limits, int step) {
    return std::lerp(limits.lower + kLimitMargin_rad, limits.upper - kLimitMargin_rad,
                     static_cast<double>(step) / (kSteps - 1));
  };
  // Postures spread over the reach of the arm's centre of mass; for each reach the one nearest to
  // the transport posture.
  std::vector<std::pair<double, ArmPosture>> postures;
  for (int b = 0; b < kSteps; ++b) {
    for (int d = 0; d < kSteps; ++d) {
      for (int t = 0; t < kSteps; ++t) {
        for (int e = 0; e < kSteps; ++e) {
          const ArmPosture posture{0.0, grid(plane.boom(), b), grid(plane.dipper(), d),
                                   grid(plane.tele(), t), grid(plane.ee_pitch(), e)};
          const ArmPlane::Points p = plane.points(posture);
          const double lowest = std::min({p.elbow.imag(), p.wrist.imag(), p.contact.imag()});
          // The bucket stays ahead of the wrist's foot: it must not fold into the cabin.
          if (lowest < kCounterWeightClear_m ||
              p.contact.real() < plane.points(folded).contact.real() - 0.5)
            continue;
          postures.emplace_back(p.moment.real(), posture);
        }
      }
    }
  }
  const auto away = [&](const ArmPosture& p) {
    return std::abs(p.boom_rad - folded.boom_rad) + std::abs(p.dipper_rad - folded.dipper_rad) +
           std::abs(p.tele_m - folded.tele_m) + std::abs(p.ee_pitch_rad - folded.ee_pitch_rad);
  };
  std::vector<ArmPosture> chosen{folded};
  if (!postures.empty()) {
    const auto [low, high] =
        std::minmax_element(postures.begin(), postures.end(),
                            [](const auto& a, const auto& b) { return a.first < b.first; });
    const double least = low->first, most = high->first;
    for (int k = 0; k + 1 < kNumReaches; ++k) {
      const double wanted = std::lerp(least, most, (k + 0.5) / (kNumReaches - 1));
      const double window = 0.5 * (most - least) / (kNumReaches - 1);
      const std::pair<double, ArmPosture>* best = nullptr;
      for (const auto& candidate : postures) {
        if (std::abs(candidate.first - wanted) > window) continue;
        if (best == nullptr || away(candidate.second) < away(best->second)) best = &candidate;
      }
      if (best != nullptr) chosen.push_back(best->second);
    }
  }
  std::vector<CounterWeight> weights;
  for (int y = 0; y < kNumYaws; ++y) {
    const double turn_rad = wrap_angle(2.0 * std::numbers::pi * y / kNumYaws);
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    for (ArmPosture posture : chosen) {
      const ArmPlane::Points p = plane.points(posture);
      posture.turn_rad = turn_rad;
      weights.push_back({posture, plane.moment_base(p.moment, c, s), plane.p_base(p.elbow, c, s),
                         plane.p_base(p.wrist, c, s), plane.p_base(p.contact, c, s)});
    }
  }
  return weights;
}

}  // namespace wex

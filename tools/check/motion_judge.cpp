#include "tools/check/motion_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/check/support_hull.hpp"

namespace wex::check {
namespace {

constexpr double kStepM = 0.01;  // of base, wheels and bucket between postures
constexpr int kMaxSteps = 500;   // between two rows
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMaxSlopeRad = 30.5 * kDegree;  // beyond it ground is untraversable
constexpr double kLookAroundM = 0.30;            // for untraversable ground
constexpr double kFootholdM = 0.30;              // swing clearance is asked for beyond this
constexpr double kBucketSpotM = 0.50;            // and of the bucket beyond this
constexpr double kTimeResolutionS = 1e-4;        // of the files: rates are rounded down by it

const std::string kMachine = "machine";

std::string limb_name(std::size_t limb) { return std::string(kLimbNames[limb]); }

/// A lifted limb on its way, to be judged once it is known where it lands.
struct Flight {
  struct Sample {
    double t_s;
    double clearance_m;  ///< what must be clear on the way
    double height_m;     ///< of the contact itself above the ground
    Eigen::Vector3d p;
  };
  std::optional<Eigen::Vector3d> from;
  std::vector<Sample> samples;
};

/// One motion's way through all rules.
class Walk {
 public:
  Walk(CheckedMachine& machine, CheckedGround& ground, Findings& findings, const Motion& motion)
      : machine_(machine), ground_(ground), findings_(findings), motion_(motion) {}

  int run() {
    const std::vector<Motion::Row>& rows = motion_.rows;
    row_at(0);
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
      judge_step(rows[k], rows[k + 1]);
      const int steps = steps_between(rows[k], rows[k + 1]);
      ContactFlags both{};
      for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
        both[limb] = rows[k].contacts[limb] && rows[k + 1].contacts[limb];
      }
      for (int step = 1; step < steps; ++step) {
        posture_at(rows[k], rows[k + 1], static_cast<double>(step) / steps, both);
      }
      row_at(k + 1);
    }
    for (std::size_t limb = 0; limb < kNumLimbs; ++limb) land(limb, std::nullopt);
    judge_slip();
    return postures_;
  }

 private:
  struct Wheel {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(), axle = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    TyreOnGround on_ground;
  };

  static CheckedPosture posture_of(const Motion::Row& row) {
    return {row.p_base, row.R_base, row.joints};
  }

  /// Kinematics and the tyres' gaps, which stay as they are while a wheel does.
  void set(const CheckedPosture& posture) {
    machine_.set(posture);
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      Wheel& wheel = wheels_[i];
      const Eigen::Vector3d centre = machine_.p_wheel(static_cast<int>(i));
      wheel.R = machine_.R_wheel(static_cast<int>(i));
      const Eigen::Vector3d axle = wheel.R.col(1);
      if (postures_ > 0 && centre == wheel.centre && axle == wheel.axle) continue;
      wheel.centre = centre;
      wheel.axle = axle;
      const CheckedTyre& tyre = machine_.tyres()[i];
      wheel.on_ground = ground_.tyre(centre, axle, tyre.radius_m, tyre.half_width_m);
    }
    ++postures_;
  }

  /// As many as make base, wheels and bucket move a centimetre each.
  int steps_between(const Motion::Row& a, const Motion::Row& b) {
    const auto marks = [&](const Motion::Row& row) {
      machine_.set(posture_of(row));
      std::array<Eigen::Vector3d, kNumWheels + 2> points;
      for (int i = 0; i < kNumWheels; ++i)
        points[static_cast<std::size_t>(i)] = machine_.p_wheel(i);
      points[kNumWheels] = row.p_base;
      points[kNumWheels + 1] = machine_.has_arm() ? machine_.p_bucket() : row.p_base;
      return points;
    };
    const auto from = marks(a), to = marks(b);
    double moved_m = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      moved_m = std::max(moved_m, (to[i] - from[i]).norm());
    }
    return std::clamp(static_cast<int>(std::ceil(moved_m / kStepM)), 1, kMaxSteps);
  }

  void row_at(std::size_t k) {
    const Motion::Row& row = motion_.rows[k];
    t_s_ = row.t_s;
    const std::array<Wheel, kNumWheels> before = wheels_;
    const ContactFlags no_contacts{};
    const ContactFlags& contacts_before = k > 0 ? motion_.rows[k - 1].contacts : no_contacts;
    set(posture_of(row));
    findings_.at(t_s_, row.p_base.x(), row.p_base.y());
    judge_joints(row.joints);
    judge_lift_and_landing(row.contacts, contacts_before, k == 0);
    if (k > 0) judge_rolling(before, row.contacts, contacts_before);
    judge_posture(row.p_base, row.R_base, row.contacts, true);
    if (k == 0) return;
    // A contact that jumps shows as one that slides fast.
    const double dt_s = row.t_s - motion_.rows[k - 1].t_s + kTimeResolutionS;
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      if (row.contacts[i] && contacts_before[i] && dt_s > 0.0) {
        findings_.at(t_s_, wheels_[i].centre.x(), wheels_[i].centre.y());
        findings_.observe(Rule::kSlide, slid_in_row_[i].norm() / dt_s, names_[i]);
      }
      slid_in_row_[i].setZero();
    }
  }

  void posture_at(const Motion::Row& a, const Motion::Row& b, double share,
                  const ContactFlags& contacts) {
    const std::array<Wheel, kNumWheels> before = wheels_;
    between_.p_base = a.p_base + share * (b.p_base - a.p_base);
    between_.R_base = a.R_base.slerp(share, b.R_base);
    between_.joints = a.joints + share * (b.joints - a.joints);
    t_s_ = a.t_s + share * (b.t_s - a.t_s);
    set(between_);
    judge_rolling(before, contacts, contacts);
    judge_posture(between_.p_base, between_.R_base, contacts, false);
  }

  void judge_step(const Motion::Row& a, const Motion::Row& b) {
    findings_.at(b.t_s, b.p_base.x(), b.p_base.y());
    const double dt_s = b.t_s - a.t_s;
    findings_.observe(Rule::kTimeStep, dt_s, kMachine);
    if (dt_s > 0.0) {
      const double rounded_dt_s = dt_s + kTimeResolutionS;
      findings_.observe(Rule::kBaseSpeed, (b.p_base - a.p_base).norm() / rounded_dt_s, kMachine);
      for (std::size_t j = 0; j < machine_.joints().size(); ++j) {
        const CheckedJoint& joint = machine_.joints()[j];
        if (joint.max_rate <= 0.0) continue;
        const auto index = static_cast<Eigen::Index>(j);
        const double rate = std::abs(b.joints[index] - a.joints[index]) / rounded_dt_s;
        findings_.observe(Rule::kJointRate, rate / joint.max_rate, joint.name);
      }
    }
    int changes = 0;
    for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
      changes += a.contacts[limb] != b.contacts[limb] ? 1 : 0;
    }
    findings_.observe(Rule::kContactChanges, changes, kMachine);
  }

  void judge_joints(const Eigen::VectorXd& q) {
    if (q_first_.size() == 0) q_first_ = q;
    for (std::size_t j = 0; j < machine_.joints().size(); ++j) {
      const CheckedJoint& joint = machine_.joints()[j];
      const double value = q[static_cast<Eigen::Index>(j)];
      if (joint.limited) {
        findings_.observe(Rule::kJointLimit, std::max(joint.lower - value, value - joint.upper),
                          joint.name);
      }
      if (joint.tyre) {
        findings_.observe(Rule::kTyreSlide,
                          std::abs(value - q_first_[static_cast<Eigen::Index>(j)]), joint.name);
      }
      if (joint.coupling.joint >= 0) {
        const double driver = q[joint.coupling.joint];
        double expected = 0.0, power = 1.0;
        for (const double coefficient : joint.coupling.polynomial) {
          expected += coefficient * power;
          power *= driver;
        }
        findings_.observe(Rule::kCoupling, std::abs(value - expected), joint.name);
      }
    }
  }

  void judge_lift_and_landing(const ContactFlags& now, const ContactFlags& before, bool first) {
    for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
      if (limb == kNumWheels && !machine_.has_arm()) continue;
      const Eigen::Vector3d p = limb < kNumWheels ? wheels_[limb].centre : machine_.p_bucket();
      if (now[limb]) {
        if (!first && !before[limb]) {
          land(limb, p);
          if (limb < kNumWheels) {
            findings_.observe(Rule::kTouchDown, wheels_[limb].on_ground.gap_m, names_[limb]);
          }
        }
        flights_[limb].from = p;
        if (limb == kNumWheels && (first || !before[limb])) bucket_stands_at_ = p;
      }
    }
  }

  void land(std::size_t limb, const std::optional<Eigen::Vector3d>& to) {
    Flight& flight = flights_[limb];
    const bool wheel = limb < kNumWheels;
    const double spot_m = wheel ? kFootholdM : kBucketSpotM;
    const auto near = [&](const Eigen::Vector3d& p, const std::optional<Eigen::Vector3d>& spot) {
      return spot && (p - *spot).head<2>().norm() <= spot_m;
    };
    for (const Flight::Sample& sample : flight.samples) {
      findings_.at(sample.t_s, sample.p.x(), sample.p.y());
      if (near(sample.p, flight.from) || near(sample.p, to)) {
        findings_.observe(Rule::kNearFoothold, sample.height_m, names_[limb]);
      } else {
        findings_.observe(wheel ? Rule::kSwingClearance : Rule::kBucketClearance,
                          sample.clearance_m, names_[limb]);
      }
    }
    flight.samples.clear();
    flight.from.reset();
  }

  /// Rolling without slip: v_centre + omega x (centre to patch) = 0.
  void judge_rolling(const std::array<Wheel, kNumWheels>& before, const ContactFlags& now,
                     const ContactFlags& then) {
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      if (!now[i] || !then[i]) continue;
      const double radius_m = machine_.tyres()[i].radius_m;
      const auto down = [](const Wheel& w) {
        return (w.axle.z() * w.axle - Eigen::Vector3d::UnitZ()).normalized().eval();
      };
      const Eigen::Vector3d axle = (before[i].axle + wheels_[i].axle).normalized();
      const Eigen::Vector3d down_now = down(wheels_[i]);
      const Eigen::Vector3d forward = axle.cross(-down_now).normalized();
      const Eigen::Vector3d moved =
          wheels_[i].centre - before[i].centre + radius_m * (down_now - down(before[i]));
      const Eigen::AngleAxisd turn(wheels_[i].R * before[i].R.transpose());
      const double turned_rad = turn.angle() * turn.axis().dot(axle);
      const double travel_m = (wheels_[i].centre - before[i].centre).dot(forward);
      travel_m_ += std::abs(travel_m);
      side_slip_m_ += std::abs(moved.dot(axle));
      rolling_error_m_ += std::abs(travel_m - radius_m * turned_rad);
      slid_in_row_[i] += Eigen::Vector2d(travel_m - radius_m * turned_rad, moved.dot(axle));
    }
  }

  void judge_slip() {
    if (travel_m_ < 1e-3) return;
    findings_.observe(Rule::kSideSlip, 100.0 * side_slip_m_ / travel_m_, "wheels");
    findings_.observe(Rule::kRollingError, 100.0 * rolling_error_m_ / travel_m_, "wheels");
  }

  void judge_posture(const Eigen::Vector3d& p_base, const Eigen::Quaterniond& R_base,
                     const ContactFlags& contacts, bool row) {
    findings_.at(t_s_, p_base.x(), p_base.y());
    const Eigen::Matrix3d R = R_base.toRotationMatrix();
    const double pitch_rad = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
    const double roll_rad = std::atan2(R(2, 1), R(2, 2));
    findings_.observe(Rule::kTilt, std::abs(pitch_rad) / kDegree, "pitch");
    findings_.observe(Rule::kTilt, std::abs(roll_rad) / kDegree, "roll");
    judge_support(contacts);
    judge_wheels(contacts, row);
    if (machine_.has_arm()) judge_bucket(contacts[kNumWheels], row);
    judge_clearances();
    findings_.at(t_s_, p_base.x(), p_base.y());
    judge_self_distance();
  }

  void judge_support(const ContactFlags& contacts) {
    support_.clear();
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      if (!contacts[i]) continue;
      const TyreOnGround& tyre = wheels_[i].on_ground;
      support_.emplace_back((tyre.known ? tyre.p_world_patch : wheels_[i].centre).head<2>());
    }
    if (contacts[kNumWheels] && machine_.has_arm()) {
      support_.push_back(machine_.p_bucket().head<2>());
    }
    findings_.observe(Rule::kCarrying, static_cast<double>(support_.size()), kMachine);
    if (support_.empty()) return;
    findings_.observe(Rule::kStability, hull_margin_m(machine_.com().head<2>(), support_),
                      kMachine);
  }

  void judge_wheels(const ContactFlags& contacts, bool row) {
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const Wheel& wheel = wheels_[i];
      const std::string& name = names_[i];
      findings_.at(t_s_, wheel.centre.x(), wheel.centre.y());
      if (!contacts[i]) {
        // Without known ground below there is nothing to hit.
        if (wheel.on_ground.known) {
          const double gap_m = wheel.on_ground.gap_m;
          flights_[i].samples.push_back({t_s_, gap_m, gap_m, wheel.centre});
        }
        continue;
      }
      findings_.observe(Rule::kUnknownGround, wheel.on_ground.known ? 0.0 : 1.0, name);
      if (!wheel.on_ground.known) continue;
      const double gap_m = wheel.on_ground.gap_m;
      findings_.observe(row ? Rule::kWheelAboveAtRows : Rule::kWheelAboveBetween, gap_m, name);
      findings_.observe(row ? Rule::kWheelBelowAtRows : Rule::kWheelBelowBetween, gap_m, name);
      judge_ground(wheel.centre, CheckedGround::Foot::kTyre, name);
    }
  }

  void judge_ground(const Eigen::Vector3d& p, CheckedGround::Foot foot, const std::string& name) {
    findings_.at(t_s_, p.x(), p.y());
    findings_.observe(Rule::kGroundSlope, ground_.slope_rad(p.x(), p.y(), foot) / kDegree, name);
    findings_.observe(
        Rule::kUntraversableDistance,
        ground_.untraversable_distance_m(p.x(), p.y(), foot, kMaxSlopeRad, kLookAroundM), name);
  }

  void judge_bucket(bool stands, bool row) {
    const Eigen::Vector3d p = machine_.p_bucket();
    if (!stands) {
      bucket_stands_at_.reset();
      double clearance_m = Findings::kFar;
      for (const CheckedMachine::Shape& shape : machine_.shapes()) {
        if (shape.role != ShapeRole::kBucket) continue;
        clearance_m = std::min(
            clearance_m, clearance_below(shape, findings_.relevant_below(Rule::kBucketClearance)));
      }
      flights_[kNumWheels].samples.push_back(
          {t_s_, clearance_m, p.z() - ground_.height_m(p.x(), p.y()), p});
      return;
    }
    findings_.at(t_s_, p.x(), p.y());
    const std::string& name = names_[kNumWheels];
    const double height_m = p.z() - ground_.height_m(p.x(), p.y());
    findings_.observe(Rule::kUnknownGround, std::isnan(height_m) ? 1.0 : 0.0, name);
    if (std::isnan(height_m)) return;
    findings_.observe(row ? Rule::kBucketHeightAtRows : Rule::kBucketHeightBetween,
                      std::abs(height_m), name);
    if (bucket_stands_at_) {
      findings_.observe(Rule::kBucketDrift, (p - *bucket_stands_at_).norm(), name);
    }
    judge_ground(p, CheckedGround::Foot::kBucket, name);
  }

  /// Height of a shape's lowest sample above the ground below it; at least `relevant_m` means that
  /// it is not known any better.
  double clearance_below(const CheckedMachine::Shape& shape, double relevant_m) const {
    const Eigen::Vector3d p = machine_.p_shape(shape);
    const Eigen::Matrix3d R = machine_.R_shape(shape);
    const double lowest_m = p.z() - R.row(2).cwiseAbs().dot(shape.half_m);
    const double around_m =
        R.topRows<2>().cwiseAbs().rowwise().sum().maxCoeff() * shape.half_m.maxCoeff();
    const double bound_m =
        lowest_m - ground_.max_height_m(p.x(), p.y(), std::min(around_m, shape.radius_m));
    if (bound_m >= relevant_m) return bound_m;
    double clearance_m = Findings::kFar;
    for (const Eigen::Vector3d& p_sample : shape.p_samples) {
      const Eigen::Vector3d s = p + R * p_sample;
      const double above_m = s.z() - shape.sample_radius_m - ground_.height_m(s.x(), s.y());
      if (above_m < clearance_m) clearance_m = above_m;  // false over unknown ground
    }
    return clearance_m;
  }

  void judge_clearances() {
    for (const CheckedMachine::Shape& shape : machine_.shapes()) {
      if (shape.role == ShapeRole::kTyre || shape.role == ShapeRole::kBucket) continue;
      const Rule rule =
          shape.role == ShapeRole::kChassis ? Rule::kChassisClearance : Rule::kLimbClearance;
      const Eigen::Vector3d p = machine_.p_shape(shape);
      findings_.at(t_s_, p.x(), p.y());
      const double clearance_m = clearance_below(shape, findings_.relevant_below(rule));
      findings_.observe(rule, std::min(clearance_m, Findings::kFar), shape.name);
    }
  }

  void judge_self_distance() {
    const double relevant_m = findings_.relevant_below(Rule::kSelfDistance);
    double least_m = Findings::kFar;
    const CheckedMachine::Pair* least = nullptr;
    for (const CheckedMachine::Pair& pair : machine_.pairs()) {
      const double limit_m = std::min(least_m, relevant_m);
      const double distance_m = machine_.distance_m(pair, limit_m);
      if (distance_m >= limit_m) continue;
      least_m = distance_m;
      least = &pair;
    }
    if (!least) return;
    const auto& shapes = machine_.shapes();
    findings_.observe(Rule::kSelfDistance, least_m,
                      shapes[static_cast<std::size_t>(least->first)].name + ", " +
                          shapes[static_cast<std::size_t>(least->second)].name);
  }

  CheckedMachine& machine_;
  CheckedGround& ground_;
  Findings& findings_;
  const Motion& motion_;
  std::array<std::string, kNumLimbs> names_{limb_name(0), limb_name(1), limb_name(2), limb_name(3),
                                            limb_name(4)};
  std::array<Wheel, kNumWheels> wheels_{};
  std::array<Flight, kNumLimbs> flights_{};
  /// Lengthwise, sideways [m].
  std::array<Eigen::Vector2d, kNumWheels> slid_in_row_ = [] {
    std::array<Eigen::Vector2d, kNumWheels> zero;
    zero.fill(Eigen::Vector2d::Zero());
    return zero;
  }();
  std::optional<Eigen::Vector3d> bucket_stands_at_;
  std::vector<Eigen::Vector2d> support_;
  CheckedPosture between_;
  Eigen::VectorXd q_first_;
  double t_s_ = 0.0, travel_m_ = 0.0, side_slip_m_ = 0.0, rolling_error_m_ = 0.0;
  int postures_ = 0;
};

}  // namespace

int judge_motion(CheckedMachine& machine, CheckedGround& ground, const Motion& motion,
                 Findings& findings) {
  return Walk(machine, ground, findings, motion).run();
}

}  // namespace wex::check

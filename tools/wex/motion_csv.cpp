#include "tools/wex/motion_csv.hpp"

#include <cstdio>

#include "models/excavator/mjcf.hpp"

namespace wex::app {
namespace {

constexpr double kRowPeriodS = 0.05;

class MotionCsv {
 public:
  MotionCsv(const std::vector<std::string>& joint_names, const Eigen::Vector2d& map_origin_m)
      : map_origin_m_(map_origin_m), num_joints_(joint_names.size()) {
    text_ = "t,base_x,base_y,base_z,base_qw,base_qx,base_qy,base_qz";
    for (const std::string& name : joint_names) text_ += "," + name;
    for (const std::string_view limb : kLimbNames) text_ += ",contact_" + std::string(limb);
    text_ += "\n";
  }

  void add(double t_s, const BaseCoordinates& base, const Eigen::VectorXd& joints,
           const ContactFlags& contacts) {
    WEX_EXPECTS(static_cast<std::size_t>(joints.size()) == num_joints_);
    const Eigen::Isometry3d T_world_base = T_world_base_from(base);
    Eigen::Quaterniond orientation(T_world_base.linear());
    // q and -q are the same attitude; the sign is kept continuous from row to row.
    if (orientation.coeffs().dot(last_orientation_.coeffs()) < 0.0) {
      orientation.coeffs() = -orientation.coeffs();
    }
    last_orientation_ = orientation;
    number(t_s, "%.4f", "");
    number(base[kBaseX] + map_origin_m_.x(), "%.6f");
    number(base[kBaseY] + map_origin_m_.y(), "%.6f");
    number(base[kBaseZ], "%.6f");
    for (const double value :
         {orientation.w(), orientation.x(), orientation.y(), orientation.z()}) {
      number(value, "%.9f");
    }
    for (const double value : joints) number(value, "%.7f");
    for (const bool contact : contacts) text_ += contact ? ",1" : ",0";
    text_ += "\n";
  }

  std::string take() { return std::move(text_); }

 private:
  void number(double value, const char* pattern, const char* separator = ",") {
    char buffer[48];
    std::snprintf(buffer, sizeof(buffer), pattern, value);
    text_ += separator;
    text_ += buffer;
  }

  Eigen::Vector2d map_origin_m_;
  std::size_t num_joints_;
  Eigen::Quaterniond last_orientation_ = Eigen::Quaterniond::Identity();
  std::string text_;
};

}  // namespace

std::string planned_motion_csv(const MachineModel& machine,
                               const std::vector<std::string>& joint_names,
                               const std::vector<WholeBodyNode>& nodes,
                               const Eigen::Vector2d& map_origin_m) {
  WEX_EXPECTS(!nodes.empty());
  MotionCsv csv(joint_names, map_origin_m);
  const double begin_s = nodes.front().t_s, end_s = nodes.back().t_s;
  constexpr double kLastRowGapS = 1e-6;
  for (int row = 0;; ++row) {
    const bool last = begin_s + row * kRowPeriodS >= end_s - kLastRowGapS;
    const WholeBodyNode node = sample(nodes, last ? end_s : begin_s + row * kRowPeriodS);
    csv.add(node.t_s, node.q.head<kNumBaseCoordinates>(), scalar_joint_values(machine, node.q),
            node.contacts);
    if (last) return csv.take();
  }
}

std::string executed_motion_csv(const std::vector<std::string>& joint_names,
                                const std::vector<DriveSample>& samples,
                                const Eigen::Vector2d& map_origin_m) {
  MotionCsv csv(joint_names, map_origin_m);
  for (const DriveSample& s : samples) {
    csv.add(s.t_s, s.base, s.scalar_joints, s.contacts);
  }
  return csv.take();
}

}  // namespace wex::app

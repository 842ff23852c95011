#include "tools/check/motion.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "models/excavator/mjcf.hpp"

namespace wex::check {
namespace {

constexpr double kUnitQuaternion = 1e-3;
const std::vector<std::string> kBaseColumns{"t",       "base_x",  "base_y",  "base_z",
                                            "base_qw", "base_qx", "base_qy", "base_qz"};

std::vector<std::string_view> split(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

/// Where in a row each wanted column stands.
Result<std::vector<std::size_t>> order_of_columns(const std::vector<std::string_view>& header,
                                                  const std::vector<std::string>& wanted,
                                                  const std::string& file) {
  std::vector<std::size_t> order;
  for (const std::string& name : wanted) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      return fail(ErrorCode::kBadInput, file + ":1: there is no column " + name);
    }
    if (std::find(found + 1, header.end(), name) != header.end()) {
      return fail(ErrorCode::kBadInput, file + ":1: column " + name + " is there twice");
    }
    order.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  for (const std::string_view name : header) {
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
      return fail(ErrorCode::kBadInput, file + ":1: column '" + std::string(name) +
                                            "' is no joint of the model beside it");
    }
  }
  return order;
}

}  // namespace

Result<Motion> read_motion(const std::filesystem::path& csv_file,
                           const std::vector<std::string>& joint_names,
                           const Eigen::Vector2d& map_origin_m) {
  const std::string file = csv_file.string();
  std::ifstream stream(csv_file, std::ios::binary);
  if (!stream) return fail(ErrorCode::kBadInput, file + ": cannot be read");
  std::vector<std::string> wanted = kBaseColumns;
  wanted.insert(wanted.end(), joint_names.begin(), joint_names.end());
  const std::size_t first_contact = wanted.size();
  for (const std::string_view limb : kLimbNames) wanted.push_back("contact_" + std::string(limb));

  std::string line;
  if (!std::getline(stream, line)) return fail(ErrorCode::kBadInput, file + ": is empty");
  const std::string header_line = line;
  const std::vector<std::string_view> header = split(header_line);
  const auto order = order_of_columns(header, wanted, file);
  if (!order) return tl::unexpected(order.error());

  Motion motion;
  motion.joint_names = joint_names;
  std::vector<double> values(wanted.size());
  for (int number = 2; std::getline(stream, line); ++number) {
    const std::string where = file + ":" + std::to_string(number) + ": ";
    const std::vector<std::string_view> fields = split(line);
    if (fields.size() != wanted.size()) {
      return fail(ErrorCode::kBadInput, where + std::to_string(fields.size()) +
                                            " fields, expected " + std::to_string(wanted.size()));
    }
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const std::string_view text = fields[(*order)[k]];
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), values[k]);
      if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(values[k])) {
        return fail(ErrorCode::kBadInput, where + "column " + wanted[k] + ": '" +
                                              std::string(text) + "' is not a finite number");
      }
    }
    Motion::Row row;
    row.t_s = values[0];
    row.p_base = {values[1] - map_origin_m.x(), values[2] - map_origin_m.y(), values[3]};
    row.R_base = Eigen::Quaterniond(values[4], values[5], values[6], values[7]);
    if (std::abs(row.R_base.norm() - 1.0) > kUnitQuaternion) {
      return fail(ErrorCode::kBadInput,
                  where + "base_qw, qx, qy, qz are no quaternion of unit length");
    }
    row.R_base.normalize();
    row.joints = Eigen::Map<const Eigen::VectorXd>(values.data() + kBaseColumns.size(),
                                                   static_cast<Eigen::Index>(joint_names.size()));
    for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
      const double flag = values[first_contact + limb];
      if (flag != 0.0 && flag != 1.0) {
        return fail(ErrorCode::kBadInput,
                    where + "column " + wanted[first_contact + limb] + " is neither 0 nor 1");
      }
      row.contacts[limb] = flag == 1.0;
    }
    motion.rows.push_back(std::move(row));
  }
  if (motion.rows.size() < 2) {
    return fail(ErrorCode::kBadInput, file + ": fewer than two rows of motion");
  }
  return motion;
}

Result<Task> read_result_task(const std::filesystem::path& json_file) {
  const std::string file = json_file.string();
  std::ifstream stream(json_file, std::ios::binary);
  if (!stream) return fail(ErrorCode::kBadInput, file + ": cannot be read");
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) return fail(ErrorCode::kBadInput, file + ": is not a JSON object");
  Task task;
  for (const auto& [key, pose] : {std::pair{"start", &task.start}, {"goal", &task.goal}}) {
    const auto value = json.find(key);
    const auto is_number = [](const nlohmann::json& entry) { return entry.is_number(); };
    if (value == json.end() || !value->is_array() || value->size() != 3 ||
        !std::all_of(value->begin(), value->end(), is_number)) {
      return fail(ErrorCode::kBadInput, file + ": \"" + key +
                                            "\" is not [x, y, yaw], three numbers in metres, "
                                            "metres, radians");
    }
    *pose = {(*value)[0], (*value)[1], (*value)[2]};
  }
  return task;
}

Result<Motion> motion_from(const MachineModel& machine, const std::vector<WholeBodyNode>& nodes) {
  auto joint_names = scalar_joint_names(machine);
  if (!joint_names) return tl::unexpected(joint_names.error());
  Motion motion;
  motion.joint_names = std::move(*joint_names);
  for (const WholeBodyNode& node : nodes) {
    const Eigen::Isometry3d T_world_base = T_world_base_from(node.q.head<kNumBaseCoordinates>());
    motion.rows.push_back({node.t_s, T_world_base.translation(),
                           Eigen::Quaterniond(T_world_base.linear()),
                           scalar_joint_values(machine, node.q), node.contacts});
  }
  return motion;
}

}  // namespace wex::check

#include "models/excavator/sidecar_loader.hpp"

#include <toml++/toml.h>

#include <cmath>
#include <set>
#include <sstream>
#include <utility>

namespace wex {
namespace {

constexpr std::int64_t kFormat = 1;

// Reads one table key by key and remembers the first complaint of the whole file.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string label, std::string file,
              std::optional<Error>& error)
      : table_(table), label_(std::move(label)), file_(std::move(file)), error_(error) {}

  double number(const std::string& key, double min, double max = 1e12) {
    const toml::node* node = required(key);
    if (!node) return min;
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value >= min) || !(*value <= max)) {
      complain(*node, key, "must be a number from " + text_of(min) + " to " + text_of(max));
      return min;
    }
    return *value;
  }
  double positive(const std::string& key) {
    const double value = number(key, 0.0);
    if (value == 0.0 && !error_) complain(*table_.get(key), key, "must be greater than 0");
    return value;
  }
  std::string text(const std::string& key) {
    const toml::node* node = required(key);
    const auto value = node ? node->value_exact<std::string>() : std::nullopt;
    if (node && (!value || value->empty())) complain(*node, key, "must be a text");
    return value.value_or("");
  }
  std::string optional_text(const std::string& key) {
    return table_.contains(key) ? text(key) : std::string();
  }
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> vector(const std::string& key) {
    Eigen::Matrix<double, kSize, 1> result = Eigen::Matrix<double, kSize, 1>::Zero();
    const toml::node* node = required(key);
    if (!node) return result;
    const toml::array* array = node->as_array();
    bool valid = array && array->size() == kSize;
    for (int i = 0; valid && i < kSize; ++i) {
      const toml::node& entry = *array->get(static_cast<std::size_t>(i));
      const auto value = entry.is_number() ? entry.value<double>() : std::nullopt;
      valid = value && std::isfinite(*value);
      if (valid) result[i] = *value;
    }
    if (!valid) complain(*node, key, "must be a list of " + std::to_string(kSize) + " numbers");
    return result;
  }
  std::vector<std::string> texts(const std::string& key) {
    std::vector<std::string> result;
    const toml::node* node = required(key);
    if (!node) return result;
    const toml::array* array = node->as_array();
    bool valid = array && !array->empty();
    for (std::size_t i = 0; valid && i < array->size(); ++i) {
      const auto value = array->get(i)->value_exact<std::string>();
      valid = value && !value->empty();
      if (valid) result.push_back(*value);
    }
    if (!valid) complain(*node, key, "must be a list of texts");
    return result;
  }
  // A missing table reads as empty, after the complaint.
  TableReader table(const std::string& key) {
    static const toml::table kEmpty;
    const toml::node* node = required(key);
    const toml::table* sub = node ? node->as_table() : nullptr;
    if (node && !sub) complain(*node, key, "must be a table");
    return {sub ? *sub : kEmpty, label_.empty() ? key : label_ + "." + key, file_, error_};
  }
  [[nodiscard]] bool contains(const std::string& key) const { return table_.contains(key); }
  [[nodiscard]] std::vector<std::string> keys() const {
    std::vector<std::string> result;
    for (const auto& [key, node] : table_) result.emplace_back(key.str());
    return result;
  }
  // Call after the last key was read.
  void refuse_other_keys() {
    for (const auto& [key, node] : table_) {
      if (!known_.contains(std::string(key.str()))) {
        complain(node, std::string(key.str()), "is not a known key");
      }
    }
  }

 private:
  static std::string text_of(double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
  }
  const toml::node* required(const std::string& key) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (!node) complain(table_, key, "is missing");
    return node;
  }
  void complain(const toml::node& where, const std::string& key, const std::string& what) {
    if (error_) return;
    std::ostringstream message;
    message << file_;
    if (const auto line = where.source().begin.line) message << ':' << line;
    message << ": '" << label_ << (label_.empty() ? "" : ".") << key << "' " << what;
    error_ = Error{ErrorCode::kBadInput, message.str()};
  }

  const toml::table& table_;
  std::string label_, file_;
  std::optional<Error>& error_;
  std::set<std::string> known_;
};

void read_limbs(TableReader limbs, Sidecar& sidecar) {
  for (int leg = 0; leg < kNumWheels; ++leg) {
    TableReader table = limbs.table(std::string(kLimbNames[leg]));
    sidecar.legs[leg] = {table.optional_text("haa"), table.optional_text("hfe"),
                         table.optional_text("steer"), table.text("wheel")};
    // The optional keys are known even where they are absent, so only others are refused.
    table.refuse_other_keys();
  }
  const std::string arm_name(kLimbNames[static_cast<int>(Limb::kArm)]);
  if (limbs.contains(arm_name)) {
    TableReader table = limbs.table(arm_name);
    Sidecar::Arm& arm = sidecar.arm.emplace();
    arm.joints = table.texts("joints");
    arm.contact_link = table.text("contact_link");
    arm.contact_point_m = table.vector<3>("contact_point_m");
    table.refuse_other_keys();
  }
  limbs.refuse_other_keys();
}

void read_actuation(TableReader actuation, Sidecar& sidecar) {
  for (const std::string& name : actuation.keys()) {
    TableReader table = actuation.table(name);
    Sidecar::ActuationClass& entry = sidecar.actuation.emplace_back();
    entry.name = name;
    entry.joints = table.texts("joints");
    entry.dead_time_s = table.number("dead_time_s", 0.0, 2.0);
    entry.lag_s = table.number("lag_s", 0.0, 2.0);
    entry.hold_stiffness = table.positive("hold_stiffness");
    entry.max_acceleration = table.positive("max_acceleration");
    table.refuse_other_keys();
  }
}

std::map<std::string, double> read_posture(TableReader posture) {
  std::map<std::string, double> values;
  for (const std::string& joint : posture.keys()) {
    values[joint] = posture.number(joint, -100.0, 100.0);
  }
  return values;
}

Sidecar read_file(TableReader root) {
  Sidecar sidecar;
  root.number("format", static_cast<double>(kFormat), static_cast<double>(kFormat));

  TableReader chassis = root.table("chassis");
  sidecar.default_base_height_m = chassis.positive("default_base_height_m");
  sidecar.belly_below_base_m = chassis.number("belly_below_base_m", 0.0);
  sidecar.belly_min_m = chassis.vector<2>("belly_min_m");
  sidecar.belly_max_m = chassis.vector<2>("belly_max_m");
  sidecar.min_turning_radius_m = chassis.positive("min_turning_radius_m");
  chassis.refuse_other_keys();

  TableReader hydraulics = root.table("hydraulics");
  sidecar.pump_flow_m3_s = hydraulics.positive("pump_flow_m3_s");
  sidecar.pump_pressure_pa = hydraulics.positive("pump_pressure_pa");
  sidecar.dead_band = hydraulics.number("dead_band", 0.0, 0.5);
  hydraulics.refuse_other_keys();

  TableReader tyre = root.table("tyre");
  sidecar.tyre_radius_m = tyre.positive("radius_m");
  sidecar.tyre_half_width_m = tyre.positive("half_width_m");
  sidecar.tyre_stiffness_n_m = tyre.positive("stiffness_n_m");
  sidecar.tyre_damping_ns_m = tyre.number("damping_ns_m", 0.0);
  tyre.refuse_other_keys();

  read_limbs(root.table("limbs"), sidecar);
  read_actuation(root.table("actuation"), sidecar);

  TableReader postures = root.table("posture");
  sidecar.default_posture = read_posture(postures.table("default"));
  sidecar.transport_posture = read_posture(postures.table("transport"));
  postures.refuse_other_keys();
  root.refuse_other_keys();
  return sidecar;
}

}  // namespace

Result<Sidecar> load_sidecar(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return fail(ErrorCode::kBadInput, path.string() + ": there is no such side-car file");
  }
  try {
    const toml::table root = toml::parse_file(path.string());
    std::optional<Error> error;
    Sidecar sidecar = read_file(TableReader(root, "", path.string(), error));
    if (error) return tl::unexpected(*error);
    return sidecar;
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kBadInput,
                path.string() + ":" + std::to_string(error.source().begin.line) +
                    ": is not valid TOML: " + std::string(error.description()));
  } catch (const std::exception& error) {
    return fail(ErrorCode::kBadInput, path.string() + ": cannot be read: " + error.what());
  }
}

}  // namespace wex

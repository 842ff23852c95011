#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "models/terrain/internal/atomic_file.hpp"
#include "models/terrain/synthetic.hpp"

namespace wex {
namespace {

using nlohmann::json;

tl::unexpected<Error> refuse(const std::filesystem::path& file, const std::string& reason) {
  return fail(ErrorCode::kBadInput, file.string() + ": " + reason);
}

Result<Pose2> pose_from(const json& document, const std::string& field,
                        const std::filesystem::path& file) {
  const auto value = document.find(field);
  if (value == document.end()) {
    return refuse(file, "has no \"" + field + "\", expected \"" + field + "\": [x, y, yaw]");
  }
  if (!value->is_array() || value->size() != 3) {
    return refuse(file, "\"" + field + "\" is " + value->dump() +
                            ", expected [x, y, yaw] in metres and radians");
  }
  for (const json& number : *value) {
    if (!number.is_number() || !std::isfinite(number.get<double>())) {
      return refuse(file,
                    "\"" + field + "\" holds " + number.dump() + ", expected a finite number");
    }
  }
  return Pose2{(*value)[0].get<double>(), (*value)[1].get<double>(), (*value)[2].get<double>()};
}

/// The JSON document of a text; the library's exceptions end here.
Result<json> parse_json(const std::string& text, const std::filesystem::path& file) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    const auto position = std::min(text.size(), error.byte);
    const auto line =
        1 + std::count(text.begin(),
                       text.begin() + static_cast<std::ptrdiff_t>(position > 0 ? position - 1 : 0),
                       '\n');
    return refuse(file, "line " + std::to_string(line) +
                            ": is not valid JSON, expected "
                            "{\"start\": [x, y, yaw], \"goal\": [x, y, yaw]}");
  } catch (const json::exception&) {
    return refuse(file, "holds a number that is out of range");
  }
}

}  // namespace

Result<Task> read_task(const std::filesystem::path& json_file) {
  const auto text = terrain_internal::read_whole_file(json_file);
  if (!text) return tl::unexpected<Error>(text.error());
  const auto document = parse_json(*text, json_file);
  if (!document) return tl::unexpected<Error>(document.error());
  if (!document->is_object()) {
    return refuse(json_file, "expected {\"start\": [x, y, yaw], \"goal\": [x, y, yaw]}");
  }
  for (const auto& entry : document->items()) {
    if (entry.key() != "start" && entry.key() != "goal") {
      return refuse(json_file, "has an unknown field \"" + entry.key() +
                                   "\", expected \"start\" and \"goal\"");
    }
  }
  const auto start = pose_from(*document, "start", json_file);
  if (!start) return tl::unexpected<Error>(start.error());
  const auto goal = pose_from(*document, "goal", json_file);
  if (!goal) return tl::unexpected<Error>(goal.error());
  return Task{*start, *goal};
}

Result<void> write_task(const Task& task, const std::filesystem::path& json_file) {
  const auto line = [](const char* name, const Pose2& pose) {
    return std::string("\"") + name + "\": " + json{pose.x_m, pose.y_m, pose.yaw_rad}.dump();
  };
  return terrain_internal::write_whole_file(
      json_file, "{\n  " + line("start", task.start) + ",\n  " + line("goal", task.goal) + "\n}\n");
}

}  // namespace wex

#include "initializer/paper/limb_table.hpp"

namespace wex {
namespace {

constexpr float kNowhereM = 1e9F;

}  // namespace

LimbTable::LimbTable(const LimbRoadmap& map, const std::function<bool(int vertex)>& wanted) {
  for (int vertex = 0; vertex < map.num_vertices(); ++vertex) {
    if (wanted && !wanted(vertex)) continue;
    vertex_.push_back(vertex);
    const Eigen::Vector3f p = map.p_base_contact.col(vertex).cast<float>();
    const Eigen::Vector3f moment = map.moment_base.col(vertex).cast<float>();
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
    moment_x_.push_back(moment.x());
    moment_y_.push_back(moment.y());
    moment_z_.push_back(moment.z());
  }
  const auto padded = static_cast<std::size_t>(num_blocks()) * kBlock;
  for (auto* column : {&x_, &y_, &moment_x_, &moment_y_, &moment_z_}) column->resize(padded, 0.0F);
  z_.resize(padded, kNowhereM);
}

}  // namespace wex

#include "initializer/roadmap/internal/roadmap_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace wex {
namespace {

static_assert(std::endian::native == std::endian::little, "roadmap files are little endian");

constexpr char kMagic[] = "wex roadmaps\n";
/// Raised whenever the bytes or how roadmaps are built changes.
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecksumBytes = sizeof(std::uint64_t);

class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_array(&value, 1);
  }
  template <typename T>
  void put_array(const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  template <typename Derived>
  void put_matrix(const Eigen::PlainObjectBase<Derived>& m) {
    put(static_cast<std::int64_t>(m.rows()));
    put(static_cast<std::int64_t>(m.cols()));
    put_array(m.data(), static_cast<std::size_t>(m.size()));
  }
  template <typename T>
  void put_vector(const std::vector<T>& values) {
    put(static_cast<std::int64_t>(values.size()));
    put_array(values.data(), values.size());
  }
  std::string bytes;
};

/// Nothing is believed beyond the end: what cannot be there is not read, and `good` falls.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}

  template <typename T>
  T get() {
    T value{};
    get_array(&value, 1);
    return value;
  }
  template <typename T>
  void get_array(T* values, std::size_t count) {
    good = good && count <= (bytes_.size() - at_) / sizeof(T);
    if (!good || count == 0) return;
    std::memcpy(values, bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  template <typename Derived>
  void get_matrix(Eigen::PlainObjectBase<Derived>& m) {
    const auto rows = get<std::int64_t>(), cols = get<std::int64_t>();
    const std::int64_t most = static_cast<std::int64_t>((bytes_.size() - at_) / sizeof(double));
    const bool fits =
        rows >= 0 && cols >= 0 && (cols == 0 || rows <= most / cols) &&
        (Derived::RowsAtCompileTime == Eigen::Dynamic || rows == Derived::RowsAtCompileTime) &&
        (Derived::ColsAtCompileTime == Eigen::Dynamic || cols == Derived::ColsAtCompileTime);
    good = good && fits;
    if (!good) return;
    m.resize(rows, cols);
    get_array(m.data(), static_cast<std::size_t>(m.size()));
  }
  template <typename T>
  void get_vector(std::vector<T>& values) {
    const auto size = get<std::int64_t>();
    good =
        good && size >= 0 && size <= static_cast<std::int64_t>((bytes_.size() - at_) / sizeof(T));
    if (!good) return;
    values.resize(static_cast<std::size_t>(size));
    get_array(values.data(), values.size());
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  bool good = true;

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

void put_limb(Writer& out, const LimbRoadmap& map) {
  out.put(static_cast<std::int32_t>(map.limb));
  out.put_vector(map.coordinates);
  out.put_matrix(map.q);
  out.put_matrix(map.p_base_contact);
  out.put_matrix(map.moment_base);
  out.put_matrix(map.distance_from_default);
  std::vector<int> ends;
  std::vector<double> lengths;
  for (const LimbRoadmap::Edge& edge : map.edges) {
    ends.insert(ends.end(), {edge.a, edge.b});
    lengths.push_back(edge.length_m);
  }
  out.put_vector(ends);
  out.put_vector(lengths);
  out.put_vector(map.first_edge);
  out.put_vector(map.neighbours);
  out.put_vector(map.first_joint_neighbour);
  out.put_vector(map.joint_neighbours);
}

LimbRoadmap get_limb(Reader& in) {
  LimbRoadmap map;
  map.limb = static_cast<Limb>(in.get<std::int32_t>());
  in.get_vector(map.coordinates);
  in.get_matrix(map.q);
  in.get_matrix(map.p_base_contact);
  in.get_matrix(map.moment_base);
  in.get_matrix(map.distance_from_default);
  std::vector<int> ends;
  std::vector<double> lengths;
  in.get_vector(ends);
  in.get_vector(lengths);
  in.get_vector(map.first_edge);
  in.get_vector(map.neighbours);
  in.get_vector(map.first_joint_neighbour);
  in.get_vector(map.joint_neighbours);
  in.good = in.good && ends.size() == 2 * lengths.size();
  if (!in.good) return map;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    map.edges.push_back({ends[2 * i], ends[2 * i + 1], lengths[i]});
  }
  return map;
}

bool is_adjacency(const std::vector<int>& first, const std::vector<int>& neighbours,
                  Eigen::Index vertices) {
  if (std::ssize(first) != vertices + 1 || first.front() != 0 ||
      first.back() != std::ssize(neighbours) || !std::is_sorted(first.begin(), first.end())) {
    return false;
  }
  return std::all_of(neighbours.begin(), neighbours.end(),
                     [&](int v) { return v >= 0 && v < vertices; });
}

/// Whether every size and index is one that can be used without looking again.
bool consistent(const LimbRoadmap& map) {
  const Eigen::Index n = map.q.cols();
  return map.q.rows() == std::ssize(map.coordinates) && map.p_base_contact.cols() == n &&
         map.moment_base.cols() == n && map.distance_from_default.size() == n &&
         is_adjacency(map.first_edge, map.neighbours, n) &&
         (map.first_joint_neighbour.empty()
              ? map.joint_neighbours.empty()
              : is_adjacency(map.first_joint_neighbour, map.joint_neighbours, n)) &&
         std::all_of(map.edges.begin(), map.edges.end(), [&](const LimbRoadmap::Edge& edge) {
           return edge.a >= 0 && edge.a < edge.b && edge.b < n;
         });
}

}  // namespace

std::uint64_t hash_bytes(const std::string& bytes, std::uint64_t hash) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

std::string to_bytes(const Roadmaps& roadmaps, const RoadmapKey& key) {
  Writer out;
  out.put(kMagic);
  out.put(kVersion);
  out.put(key);
  const RoadmapSettings& s = roadmaps.settings;
  out.put(s.leg_vertices);
  out.put(s.arm_vertices);
  out.put(s.neighbours);
  out.put(s.joint_neighbours);
  out.put(s.max_leg_edge_m);
  out.put(s.max_arm_edge_m);
  out.put(s.self_collision_m);
  out.put(s.seed);
  out.put(static_cast<std::int32_t>(roadmaps.limbs.size()));
  for (const LimbRoadmap& map : roadmaps.limbs) put_limb(out, map);
  out.put(hash_bytes(out.bytes));
  return std::move(out.bytes);
}

Result<Roadmaps, std::string> roadmaps_from(const std::string& bytes, const RoadmapKey& key) {
  const auto refuse = [](const char* why) { return tl::unexpected(std::string(why)); };
  Reader in(bytes);
  char magic[sizeof(kMagic)] = {};
  in.get_array(magic, sizeof(magic));
  if (!in.good || std::memcmp(magic, kMagic, sizeof(kMagic)) != 0) {
    return refuse("is no roadmap file");
  }
  if (in.get<std::uint32_t>() != kVersion || !in.good) return refuse("is of another version");
  const auto made_for = in.get<RoadmapKey>();
  if (!in.good || bytes.size() < kChecksumBytes) return refuse("ends too early");
  const std::string content = bytes.substr(0, bytes.size() - kChecksumBytes);
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + content.size(), kChecksumBytes);
  if (hash_bytes(content) != checksum) return refuse("is damaged: its checksum is wrong");
  if (made_for.machine != key.machine) return refuse("was made for another machine");
  if (made_for.settings != key.settings) return refuse("was made with other settings");

  Roadmaps roadmaps;
  RoadmapSettings& s = roadmaps.settings;
  s.leg_vertices = in.get<int>();
  s.arm_vertices = in.get<int>();
  s.neighbours = in.get<int>();
  s.joint_neighbours = in.get<int>();
  s.max_leg_edge_m = in.get<double>();
  s.max_arm_edge_m = in.get<double>();
  s.self_collision_m = in.get<double>();
  s.seed = in.get<std::uint64_t>();
  const auto limbs = in.get<std::int32_t>();
  for (int i = 0; in.good && i < limbs; ++i) {
    roadmaps.limbs.push_back(get_limb(in));
    in.good = in.good && consistent(roadmaps.limbs.back());
  }
  (void)in.get<std::uint64_t>();  // the checksum
  if (!in.good || !in.at_end()) return refuse("is damaged: its sizes do not fit");
  return roadmaps;
}

}  // namespace wex

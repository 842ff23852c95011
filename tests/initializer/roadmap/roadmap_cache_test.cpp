#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "initializer/roadmap/limb_roadmap.hpp"

namespace wex {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RoadmapSettings small() {
  RoadmapSettings settings;
  settings.leg_vertices = 20;
  settings.arm_vertices = 30;
  return settings;
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void expect_equal(const Roadmaps& a, const Roadmaps& b) {
  EXPECT_EQ(a.settings, b.settings);
  ASSERT_EQ(a.limbs.size(), b.limbs.size());
  for (std::size_t i = 0; i < a.limbs.size(); ++i) {
    const LimbRoadmap &x = a.limbs[i], &y = b.limbs[i];
    EXPECT_EQ(x.limb, y.limb);
    EXPECT_EQ(x.coordinates, y.coordinates);
    EXPECT_EQ(x.q, y.q);
    EXPECT_EQ(x.p_base_contact, y.p_base_contact);
    EXPECT_EQ(x.moment_base, y.moment_base);
    EXPECT_EQ(x.distance_from_default, y.distance_from_default);
    EXPECT_EQ(x.edges, y.edges);
    EXPECT_EQ(x.first_edge, y.first_edge);
    EXPECT_EQ(x.neighbours, y.neighbours);
    EXPECT_EQ(x.first_joint_neighbour, y.first_joint_neighbour);
    EXPECT_EQ(x.joint_neighbours, y.joint_neighbours);
  }
}

class RoadmapCache : public ::testing::Test {
 protected:
  RoadmapCache()
      : folder_(fs::temp_directory_path() /
                ("wex_roadmap_cache_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        machine_(load_machine("m545").value()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~RoadmapCache() override { fs::remove_all(folder_); }

  Roadmaps load(const MachineModel& machine, const RoadmapSettings& settings = small()) {
    auto roadmaps = load_or_build_roadmaps(machine, settings, folder_ / "cache", &remark_);
    EXPECT_TRUE(roadmaps) << roadmaps.error().message;
    return std::move(*roadmaps);
  }
  fs::path file(const MachineModel& machine, const RoadmapSettings& settings = small()) const {
    return roadmap_file(machine, settings, folder_ / "cache").value();
  }
  MachineModel walker() const { return load_machine(WEX_TEST_DATA_DIR "/small_walker").value(); }
  /// Refused for `reason`, built again, and kept.
  void expect_rebuilt(const Roadmaps& expected, const std::string& reason) {
    expect_equal(load(machine_), expected);
    EXPECT_THAT(remark_, HasSubstr(reason));
    EXPECT_THAT(remark_, HasSubstr(file(machine_).string()));
    expect_equal(load(machine_), expected);
    EXPECT_THAT(remark_, IsEmpty());
  }

  fs::path folder_;
  const MachineModel machine_;
  std::string remark_ = "from before";
};

TEST_F(RoadmapCache, GivesBackWhatWasBuilt) {
  const Roadmaps built = load(machine_);
  EXPECT_THAT(remark_, IsEmpty());
  expect_equal(built, build_roadmaps(machine_, CollisionModel::build(machine_), small()));
  const std::string bytes = content(file(machine_));
  EXPECT_FALSE(bytes.empty());
  expect_equal(load(machine_), built);
  EXPECT_THAT(remark_, IsEmpty());
  EXPECT_EQ(content(file(machine_)), bytes);
}

TEST_F(RoadmapCache, IsReallyReadFrom) {
  (void)load(machine_);
  const auto written = fs::last_write_time(file(machine_));
  fs::last_write_time(file(machine_), written - std::chrono::hours(1));
  (void)load(machine_);
  EXPECT_EQ(fs::last_write_time(file(machine_)), written - std::chrono::hours(1));
}

TEST_F(RoadmapCache, LeavesNothingBesideTheFile) {
  (void)load(machine_);
  const auto files = std::distance(fs::directory_iterator(folder_ / "cache"), {});
  EXPECT_EQ(files, 1);
}

TEST_F(RoadmapCache, RefusesATruncatedFileWhereverItEnds) {
  const Roadmaps built = load(machine_);
  const std::string bytes = content(file(machine_));
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{60},
                                 std::size_t{30}, std::size_t{10}, std::size_t{0}}) {
    write(file(machine_), bytes.substr(0, size));
    expect_rebuilt(built, size < 14   ? "is no roadmap file"
                          : size < 34 ? "ends too early"
                                      : "damaged");
  }
}

TEST_F(RoadmapCache, RefusesAFileWithOneWrongByte) {
  const Roadmaps built = load(machine_);
  std::string bytes = content(file(machine_));
  bytes[bytes.size() / 3] ^= 0x10;
  write(file(machine_), bytes);
  expect_rebuilt(built, "is damaged: its checksum is wrong");
}

TEST_F(RoadmapCache, RefusesAnotherVersion) {
  const Roadmaps built = load(machine_);
  std::string bytes = content(file(machine_));
  ++bytes[14];  // after "wex roadmaps\n" and its end
  write(file(machine_), bytes);
  expect_rebuilt(built, "is of another version");
}

TEST_F(RoadmapCache, RefusesSomethingElse) {
  const Roadmaps built = load(machine_);
  write(file(machine_), std::string(5000, 'x'));
  expect_rebuilt(built, "is no roadmap file");
}

TEST_F(RoadmapCache, RefusesTheRoadmapOfAnotherMachine) {
  const Roadmaps built = load(machine_);
  const MachineModel other = walker();
  (void)load(other);
  ASSERT_NE(file(other), file(machine_));
  fs::copy_file(file(other), file(machine_), fs::copy_options::overwrite_existing);
  expect_rebuilt(built, "was made for another machine");
}

TEST_F(RoadmapCache, RefusesOtherSettings) {
  const Roadmaps built = load(machine_);
  RoadmapSettings other = small();
  other.self_collision_m = 0.2;
  (void)load(machine_, other);
  ASSERT_NE(file(machine_, other), file(machine_));
  fs::copy_file(file(machine_, other), file(machine_), fs::copy_options::overwrite_existing);
  expect_rebuilt(built, "was made with other settings");
}

TEST_F(RoadmapCache, EverySettingCounts) {
  std::vector<RoadmapSettings> all(9, small());
  all[1].leg_vertices = 21;
  all[2].arm_vertices = 31;
  all[3].neighbours = 9;
  all[4].max_leg_edge_m = 0.31;
  all[5].max_arm_edge_m = 1.1;
  all[6].self_collision_m = 0.11;
  all[7].seed = 2;
  all[8].joint_neighbours = 9;
  std::set<fs::path> files;
  for (const RoadmapSettings& settings : all) files.insert(file(machine_, settings));
  EXPECT_EQ(files.size(), all.size());
}

TEST_F(RoadmapCache, AChangedMachineFileIsAnotherMachine) {
  const fs::path copy = folder_ / "small_walker";
  fs::copy(WEX_TEST_DATA_DIR "/small_walker", copy);
  const fs::path before = file(load_machine(copy.string()).value());
  std::ofstream(copy / "small_walker.toml", std::ios::app) << "\n# a remark\n";
  EXPECT_NE(file(load_machine(copy.string()).value()), before);
}

TEST_F(RoadmapCache, NamesTheMachineFileThatIsGone) {
  const fs::path copy = folder_ / "small_walker";
  fs::copy(WEX_TEST_DATA_DIR "/small_walker", copy);
  const MachineModel machine = load_machine(copy.string()).value();
  fs::remove(copy / "small_walker.urdf");
  const auto roadmaps = load_or_build_roadmaps(machine, small(), folder_ / "cache");
  ASSERT_FALSE(roadmaps);
  EXPECT_EQ(roadmaps.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(roadmaps.error().message, HasSubstr("small_walker.urdf"));
}

TEST_F(RoadmapCache, NamesTheGivenFolderThatCannotBeWritten) {
  write(folder_ / "a_file", "in the way");
  const auto roadmaps = load_or_build_roadmaps(machine_, small(), folder_ / "a_file" / "cache");
  ASSERT_FALSE(roadmaps);
  EXPECT_EQ(roadmaps.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(roadmaps.error().message, HasSubstr((folder_ / "a_file" / "cache").string()));
}

TEST_F(RoadmapCache, WithoutAWritableDefaultFolderBuildsAndSaysSo) {
  write(folder_ / "a_file", "in the way");
  ::setenv("XDG_CACHE_HOME", (folder_ / "a_file").c_str(), 1);
  const auto roadmaps = load_or_build_roadmaps(machine_, small(), {}, &remark_);
  ASSERT_TRUE(roadmaps) << roadmaps.error().message;
  EXPECT_EQ(roadmaps->limbs.size(), 5U);
  EXPECT_THAT(remark_, HasSubstr("cannot be written"));
}

TEST_F(RoadmapCache, DefaultFolderIsThatOfTheSystem) {
  ::setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  EXPECT_EQ(roadmap_file(machine_, small()).value().parent_path(), folder_ / "wex");
  ::unsetenv("XDG_CACHE_HOME");
  ::setenv("HOME", folder_.c_str(), 1);
  EXPECT_EQ(roadmap_file(machine_, small()).value().parent_path(), folder_ / ".cache" / "wex");
  ::unsetenv("HOME");
  const auto roadmaps = load_or_build_roadmaps(machine_, small(), {}, &remark_);
  ASSERT_TRUE(roadmaps) << roadmaps.error().message;
  EXPECT_THAT(remark_, HasSubstr("HOME"));
}

}  // namespace
}  // namespace wex

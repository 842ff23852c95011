#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "models/terrain/synthetic.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/check/checked_motions.hpp"
#include "tools/check/check_command.hpp"

namespace wex::check {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Files of a plan, whole, and ways to spoil them.
class PlanFiles {
 public:
  explicit PlanFiles(const Plan& plan) : scratch_("check") {
    const Raster raster = test::make_raster();
    origin_m_ = raster.map_origin_m;
    if (!write_esri_ascii(raster, map())) throw std::runtime_error("no map");
    (void)scratch_.with("model.xml", machine_mjcf(test::machine()).value());
    const auto pose = [&](const Pose2& p) {
      return nlohmann::json{p.x_m + origin_m_.x(), p.y_m + origin_m_.y(), p.yaw_rad};
    };
    (void)scratch_.with(
        "result.json",
        nlohmann::json{{"start", pose(plan.task.start)}, {"goal", pose(plan.task.goal)}}.dump());
    const Motion motion = motion_from(test::machine(), plan.nodes).value();
    std::ostringstream text;
    text.precision(12);
    text << "t,base_x,base_y,base_z,base_qw,base_qx,base_qy,base_qz";
    for (const std::string& name : motion.joint_names) text << ',' << name;
    for (const std::string_view limb : kLimbNames) text << ",contact_" << limb;
    for (const Motion::Row& row : motion.rows) {
      const Eigen::Quaterniond& q = row.R_base;
      text << '\n'
           << row.t_s << ',' << row.p_base.x() + origin_m_.x() << ','
           << row.p_base.y() + origin_m_.y() << ',' << row.p_base.z() << ',' << q.w() << ','
           << q.x() << ',' << q.y() << ',' << q.z();
      for (const double value : row.joints) text << ',' << value;
      for (const bool contact : row.contacts) text << ',' << (contact ? 1 : 0);
    }
    text << '\n';
    (void)scratch_.with("plan.csv", text.str());
  }

  [[nodiscard]] std::filesystem::path folder() const { return scratch_.path(); }
  [[nodiscard]] std::filesystem::path map() const { return scratch_ / "map.asc"; }
  /// Replaces the first `from` of a file.
  void spoil(const std::string& name, const std::string& from, const std::string& to) {
    std::ifstream stream(scratch_ / name, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    std::string all = text.str();
    const std::size_t at = all.find(from);
    if (at == std::string::npos) throw std::runtime_error("'" + from + "' is not in " + name);
    (void)scratch_.with(name, all.replace(at, from.size(), to));
  }
  void remove(const std::string& name) { std::filesystem::remove(scratch_ / name); }
  void write(const std::string& name, const std::string& text) { (void)scratch_.with(name, text); }

  [[nodiscard]] Result<CheckReport> check() const {
    return check_plan(folder(), map(), MotionKind::kPlan);
  }
  [[nodiscard]] std::string refusal() const {
    const Result<CheckReport> report = check();
    if (report) return "(not refused)";
    EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
    return report.error().message;
  }

 private:
  ScratchFolder scratch_;
  Eigen::Vector2d origin_m_;
};

TEST(CheckFiles, AGoodPlanIsAcceptedWithExitCodeZeroTableAndJson) {
  const PlanFiles files(test::driving());
  CheckOptions options;
  options.folder = files.folder();
  options.map = files.map();
  options.json = files.folder() / "check.json";
  std::ostringstream out;
  const Result<int> code = run_check(options, out);
  ASSERT_TRUE(code) << code.error().message;
  EXPECT_EQ(*code, 0) << out.str();
  EXPECT_THAT(out.str(), AllOf(HasSubstr("plan accepted"), HasSubstr("stability margin")));
  std::ifstream stream(options.json);
  const nlohmann::json json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["schema"], "wex-check-1");
  EXPECT_EQ(json["accepted"], true);
  EXPECT_EQ(json["rows"], 51);
  EXPECT_GE(json["rules"].size(), 30U);
}

TEST(CheckFiles, AViolationIsExitCodeFiveAndSaidInOneSentence) {
  Plan plan = test::driving();
  plan.nodes[20].q[test::coordinate("LF_HFE")] += 0.055;
  const PlanFiles files(plan);
  CheckOptions options;
  options.folder = files.folder();
  options.map = files.map();
  std::ostringstream out;
  const Result<int> code = run_check(options, out);
  ASSERT_TRUE(code) << code.error().message;
  EXPECT_EQ(*code, 5);
  EXPECT_THAT(out.str(), AllOf(HasSubstr("plan refused"), HasSubstr("FAILS"), HasSubstr("LF")));
}

TEST(CheckFiles, FilesAndMemoryGiveTheSameVerdict) {
  const Plan plan = test::front_pair_on_the_bucket();
  const PlanFiles files(plan);
  const Result<CheckReport> read = files.check();
  ASSERT_TRUE(read) << read.error().message;
  const CheckReport known = check_plan(test::machine(), test::make_raster(), plan).value();
  EXPECT_TRUE(read->accepted) << check_table(*read);
  for (std::size_t i = 0; i < known.findings.size(); ++i) {
    if (known.findings[i].rule.find("slides") != std::string::npos) continue;  // rounding / time
    EXPECT_NEAR(read->findings[i].worst, known.findings[i].worst, 1e-4) << known.findings[i].rule;
  }
}

TEST(CheckFiles, AMissingFileIsNamed) {
  for (const char* name : {"model.xml", "result.json", "plan.csv"}) {
    PlanFiles files(test::driving());
    files.remove(name);
    EXPECT_THAT(files.refusal(), HasSubstr(name));
  }
  const PlanFiles files(test::driving());
  const auto report = check_plan(files.folder(), files.folder() / "no.asc", MotionKind::kPlan);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("no.asc"));
}

TEST(CheckFiles, AMissingColumnIsNamed) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", ",BOOM,", ",BOOOM,");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:1"), HasSubstr("BOOM")));
}

TEST(CheckFiles, AColumnThatIsNoJointIsNamed) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", ",contact_LF", ",wings,contact_LF");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:1"), HasSubstr("wings")));
}

TEST(CheckFiles, AColumnThatIsThereTwiceIsNamed) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", ",contact_RF", ",contact_LF");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:1"), HasSubstr("contact_")));
}

TEST(CheckFiles, AnythingButAFiniteNumberIsRefusedWithLineAndColumn) {
  for (const char* text : {"0.8x", "nan", "inf", ""}) {
    PlanFiles files(test::driving());
    files.spoil("plan.csv", "\n0.8,", std::string("\n") + text + ",");
    EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:4: column t:"), HasSubstr(text)));
  }
}

TEST(CheckFiles, ARowThatIsTooShortIsNamed) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", "\n0.8,", "\n");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:4"), HasSubstr("fields")));
}

TEST(CheckFiles, AContactThatIsNoFlagIsNamed) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", ",1,1,1,1,0\n", ",1,1,1,0.5,0\n");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:2"), HasSubstr("contact_RH")));
}

TEST(CheckFiles, AQuaternionThatIsNotOfUnitLengthIsRefused) {
  PlanFiles files(test::driving());
  files.spoil("plan.csv", ",1,0,0,0,", ",1,0,0.1,0,");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("plan.csv:2"), HasSubstr("quaternion")));
}

TEST(CheckFiles, AMotionOfOneRowIsRefused) {
  PlanFiles files(test::driving());
  files.write("plan.csv", "");
  EXPECT_THAT(files.refusal(), HasSubstr("plan.csv: is empty"));
  Plan plan = test::driving();
  plan.nodes.resize(1);
  EXPECT_THAT(PlanFiles(plan).refusal(), HasSubstr("fewer than two rows"));
}

TEST(CheckFiles, AModelThatIsNoneIsRefusedWithItsName) {
  PlanFiles files(test::driving());
  files.write("model.xml", "<mujoco><worldbody/>");
  EXPECT_THAT(files.refusal(), HasSubstr("model.xml"));
  PlanFiles other(test::driving());
  other.spoil("model.xml", "site name=\"LF_wheel\"", "site name=\"LF_hoof\"");
  EXPECT_THAT(other.refusal(), AllOf(HasSubstr("model.xml"), HasSubstr("LF_wheel")));
}

TEST(CheckFiles, AResultWithoutGoalIsRefused) {
  PlanFiles files(test::driving());
  files.spoil("result.json", "\"goal\"", "\"aim\"");
  EXPECT_THAT(files.refusal(), AllOf(HasSubstr("result.json"), HasSubstr("goal")));
  files.write("result.json", "{\"start\":[0,0,0],\"goal\":[0,0,\"x\"]}");
  EXPECT_THAT(files.refusal(), HasSubstr("goal"));
  files.write("result.json", "[");
  EXPECT_THAT(files.refusal(), HasSubstr("result.json"));
}

TEST(CheckFiles, AnUnknownKindIsRefused) {
  const PlanFiles files(test::driving());
  CheckOptions options;
  options.folder = files.folder();
  options.map = files.map();
  options.what = "dreamt";
  std::ostringstream out;
  const Result<int> code = run_check(options, out);
  ASSERT_FALSE(code);
  EXPECT_THAT(code.error().message, HasSubstr("dreamt"));
}

}  // namespace
}  // namespace wex::check

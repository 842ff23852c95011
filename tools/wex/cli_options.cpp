#include "tools/wex/cli_options.hpp"

#include <map>

#include "tools/wex/options.hpp"

namespace wex::app {

void add_machine(CLI::App& command, std::string& machine) {
  command
      .add_option("--machine", machine,
                  "Machine: a name in models/excavator/machines, or a folder with NAME.urdf and "
                  "NAME.toml")
      ->type_name("NAME")
      ->capture_default_str();
}

void add_plan_settings(CLI::App& command, PlanSettings& plan) {
  static const std::map<std::string, PlanMode> kModes{{"certified", PlanMode::kCertified},
                                                      {"drive", PlanMode::kDriveOnly},
                                                      {"paper", PlanMode::kPaper}};
  static const std::map<std::string, PlannerKind> kPlanners{{"rrtsharp", PlannerKind::kRrtSharp},
                                                            {"rrtstar", PlannerKind::kRrtStar},
                                                            {"bitstar", PlannerKind::kBitStar},
                                                            {"prmstar", PlannerKind::kPrmStar}};
  command
      .add_option("--mode", plan.mode,
                  "certified: drive where it can, step where it must; drive: on four wheels only; "
                  "paper: the scheme as published")
      ->transform(CLI::CheckedTransformer(kModes))
      ->type_name("MODE")
      ->default_str("certified");
  command
      .add_option("--stepping-penalty", plan.stepping_penalty,
                  "Factor on the cost of lifting wheels: large to drive round, 0 to step freely")
      ->check(CLI::Range(0.0, 1000.0))
      ->type_name("F")
      ->capture_default_str();
  const auto add_ablation = [&](const char* name, bool& mechanism, const char* help) {
    command.add_flag_callback(name, [&mechanism] { mechanism = false; }, help);
  };
  PlanAblation& ablation = plan.ablation;
  add_ablation("--no-certificate-first", ablation.certificate_first,
               "Ablation: search at once, without a certificate of the direct path");
  add_ablation("--no-alignment", ablation.alignment, "Ablation: obstacles may be met at any angle");
  add_ablation("--no-blocking", ablation.blocking, "Ablation: places where paths failed stay open");
  add_ablation("--no-certified-tree", ablation.certified_tree,
               "Ablation: no tree of certified states as fallback");
  command
      .add_option("--planner", plan.planner,
                  "Of the paper's mode: rrtsharp, rrtstar, bitstar or prmstar")
      ->transform(CLI::CheckedTransformer(kPlanners))
      ->type_name("PLANNER")
      ->default_str("rrtsharp");
  add_ablation("--no-filtered-heights", ablation.filtered_heights,
               "Ablation of the paper's mode: base poses by the raw terrain alone");
  add_ablation("--no-nearest-traversable", ablation.nearest_traversable,
               "Ablation of the paper's mode: base poses by the terrain underneath alone");
  add_ablation("--no-arm-centring", ablation.arm_centring,
               "Ablation of the paper's mode: on three wheels the arm stays where it is");
  add_ablation("--no-arm-support", ablation.arm_support,
               "Ablation of the paper's mode: the bucket never carries");
}

int refuse(std::ostream& err, const Error& error) {
  err << "wex: " << error.message << "\n";
  return exit_code(error.code);
}

}  // namespace wex::app

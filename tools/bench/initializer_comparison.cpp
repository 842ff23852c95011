#include "tools/bench/initializer_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "tools/bench/initializer_bench_table.hpp"

namespace wex {
namespace {

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

struct Counts {
  int runs = 0, with_path = 0, accepted = 0;
  std::vector<double> first_s;

  void add(const InitializerRow& row) {
    ++runs;
    with_path += row.paths > 0;
    accepted += row.accepted;
    if (row.accepted) first_s.push_back(row.first_s);
  }
};

std::string seconds(double value) {
  return std::isnan(value) ? format("%9s", "-") : format("%9.3f", value);
}

Counts counts_of(const InitializerVariantRows& variant, const std::string& cell) {
  Counts counts;
  for (const InitializerRow& row : variant.rows) {
    if (row.cell == cell) counts.add(row);
  }
  return counts;
}

std::vector<std::string> terrains_of(const std::vector<InitializerCell>& cells) {
  std::vector<std::string> terrains;
  for (const InitializerCell& cell : cells) {
    if (std::find(terrains.begin(), terrains.end(), cell.terrain) == terrains.end()) {
      terrains.push_back(cell.terrain);
    }
  }
  return terrains;
}

}  // namespace

std::vector<InitializerVariant> initializer_variants(InitializerComparison what) {
  const InitializerVariant certified{"default", PlanMode::kCertified};
  const InitializerVariant paper{"--mode paper", PlanMode::kPaper};
  switch (what) {
    case InitializerComparison::kNone:
      return {};
    case InitializerComparison::kModes:
      return {certified, paper};
    case InitializerComparison::kMechanisms:
      break;
  }
  using Ablation = PlanAblation;
  return {
      certified,
      {"--no-certificate-first", PlanMode::kCertified, &Ablation::certificate_first},
      {"--no-alignment", PlanMode::kCertified, &Ablation::alignment},
      {"--no-blocking", PlanMode::kCertified, &Ablation::blocking},
      {"--no-certified-tree", PlanMode::kCertified, &Ablation::certified_tree},
      paper,
      {"--mode paper --no-filtered-heights", PlanMode::kPaper, &Ablation::filtered_heights},
      {"--mode paper --no-nearest-traversable", PlanMode::kPaper, &Ablation::nearest_traversable},
      {"--mode paper --no-arm-centring", PlanMode::kPaper, &Ablation::arm_centring},
      {"--mode paper --no-arm-support", PlanMode::kPaper, &Ablation::arm_support},
  };
}

std::string comparison_by_cell(const std::vector<InitializerCell>& cells,
                               const std::vector<InitializerVariantRows>& variants) {
  std::string text = format("%-22s", "cell");
  for (const InitializerVariantRows& variant : variants) {
    text += format("  | %-28s", variant.variant.name.c_str());
  }
  text += format("\n%-22s", "");
  for (std::size_t i = 0; i < variants.size(); ++i) text += "  |  paths  accepted  first [s]";
  text += "\n";
  for (const InitializerCell& cell : cells) {
    text += format("%-22s", cell.name.c_str());
    for (const InitializerVariantRows& variant : variants) {
      const Counts counts = counts_of(variant, cell.name);
      text += format("  |  %5d  %5d/%-2d ", counts.with_path, counts.accepted, counts.runs) +
              seconds(percentile(counts.first_s, 0.5));
    }
    text += "\n";
  }
  return text;
}

std::string comparison_by_variant(const std::vector<InitializerCell>& cells,
                                  const std::vector<InitializerVariantRows>& variants) {
  const std::vector<std::string> terrains = terrains_of(cells);
  std::string text = format("%-40s", "accepted plans, paths of the base, seeds");
  for (const std::string& terrain : terrains) text += format(" %10s", terrain.c_str());
  text += format(" %11s %9s %9s\n", "all", "first [s]", "95 %");
  for (const InitializerVariantRows& variant : variants) {
    text += format("%-40s", variant.variant.name.c_str());
    Counts all;
    for (const std::string& terrain : terrains) {
      Counts here;
      for (const InitializerCell& cell : cells) {
        if (cell.terrain != terrain) continue;
        for (const InitializerRow& row : variant.rows) {
          if (row.cell != cell.name) continue;
          here.add(row);
          all.add(row);
        }
      }
      text += format(" %10s", format("%d/%d/%d", here.accepted, here.with_path, here.runs).c_str());
    }
    text += format(" %11s ", format("%d/%d/%d", all.accepted, all.with_path, all.runs).c_str()) +
            seconds(percentile(all.first_s, 0.5)) + " " + seconds(percentile(all.first_s, 0.95)) +
            "\n";
  }
  return text;
}

Result<void> compare_initializers(const InitializerBenchOptions& options,
                                  InitializerComparison what, std::ostream& out,
                                  std::ostream& err) {
  std::vector<InitializerVariantRows> variants;
  std::vector<InitializerCell> cells;
  for (const InitializerVariant& variant : initializer_variants(what)) {
    InitializerBenchOptions own = options;
    own.plan.mode = variant.mode;
    own.plan.ablation = {};
    if (variant.off != nullptr) own.plan.ablation.*variant.off = false;
    own.out = options.out / ("variant_" + std::to_string(variants.size() + 1));
    err << variant.name << std::endl;
    std::ostringstream table;
    auto outcome = bench_initializer(own, table, err);
    if (!outcome) return tl::unexpected<Error>(outcome.error());
    cells = outcome->cells;
    variants.push_back({variant, std::move(outcome->rows)});
  }
  if (what == InitializerComparison::kModes) out << comparison_by_cell(cells, variants) << "\n";
  out << comparison_by_variant(cells, variants) << "rows: " << options.out.string()
      << "/variant_*/initializer_bench.csv\n";
  return {};
}

}  // namespace wex

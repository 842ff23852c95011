// Certificates whose sequences somebody else has a say in.
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "initializer/stepping/certificate.hpp"
#include "test_worlds.hpp"

namespace wex {
namespace {

constexpr int kMaxObjections = 12;

class CertificateJudge : public testing::Test {
 protected:
  [[nodiscard]] Result<CertifiedSequence, CertificateFailure> certify(
      const SequenceJudge& judge) const {
    return certifier_.certify(path_, std::nullopt, judge);
  }
  /// The first state of a sequence with wheels in the air, after `from`.
  static std::size_t first_lifted(const CertifiedSequence& sequence, std::size_t from = 0) {
    while (sequence.states[from].support.lifted == 0) ++from;
    return from;
  }

  const TerrainMap map_ =
      make_map(30.0, 16.0, [](double x, double) { return std::abs(x) < 1.0 ? -4.0 : 0.0; });
  const DrivePath path_{{{-7.5, 0.0, 0.0}, 0.0, 15.0}};
  const Certifier certifier_ = *Certifier::build(map_, test_machine(), PlanSettings{});
};

TEST_F(CertificateJudge, WithoutObjectionsChangesNothing) {
  int calls = 0;
  const auto plain = certify({});
  const auto judged = certify([&](const CertifiedSequence&) {
    ++calls;
    return std::optional<Objection>{};
  });
  ASSERT_TRUE(plain && judged);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(plain->cost, judged->cost);
  EXPECT_EQ(plain->states.size(), judged->states.size());
}

TEST_F(CertificateJudge, StatesObjectedToAreAvoided) {
  std::vector<SteppingState> refused;
  double last_cost = 0.0;
  const auto sequence = certify([&](const CertifiedSequence& told) -> std::optional<Objection> {
    EXPECT_GE(told.cost, last_cost - 1e-3) << "the next best comes next";
    last_cost = told.cost;
    if (refused.size() == 4) return std::nullopt;
    const std::size_t state = first_lifted(told);
    refused.push_back(told.states[state]);
    return Objection{state, "not this one"};
  });
  ASSERT_TRUE(sequence) << sequence.error().why;
  ASSERT_EQ(refused.size(), 4U);
  for (const SteppingState& state : sequence->states) {
    for (const SteppingState& bad : refused) {
      EXPECT_FALSE(state.station == bad.station && state.base == bad.base &&
                   state.support.lifted == bad.support.lifted)
          << "station " << state.station;
    }
  }
}

TEST_F(CertificateJudge, ABucketPointObjectedToIsNotUsedForTheseWheelsAgain) {
  std::set<std::pair<int, std::uint8_t>> refused;
  const auto sequence = certify([&](const CertifiedSequence& told) -> std::optional<Objection> {
    if (refused.size() == 3) return std::nullopt;
    const std::size_t state = first_lifted(told);
    const Support& support = told.states[state].support;
    EXPECT_GE(support.bucket, 0);
    EXPECT_TRUE(refused.emplace(support.bucket, support.lifted).second) << "told again";
    return Objection{state, "the bucket cannot stand there", true};
  });
  ASSERT_TRUE(sequence) << sequence.error().why;
  for (const SteppingState& state : sequence->states) {
    EXPECT_FALSE(refused.contains({state.support.bucket, state.support.lifted}));
  }
}

TEST_F(CertificateJudge, SeesTwelveObjectionsThroughAndThenGivesUp) {
  for (const int objections : {kMaxObjections, kMaxObjections + 1}) {
    SCOPED_TRACE(objections);
    int told = 0;
    Pose2 first_place;
    const auto sequence =
        certify([&](const CertifiedSequence& candidate) -> std::optional<Objection> {
          if (told == objections) return std::nullopt;
          const std::size_t state = first_lifted(candidate);
          if (told == 0) first_place = candidate.stations[candidate.states[state].station].pose;
          return Objection{state, "reason " + std::to_string(told++)};
        });
    EXPECT_EQ(sequence.has_value(), objections == kMaxObjections);
    EXPECT_EQ(told, objections);
    if (sequence) continue;
    EXPECT_EQ(sequence.error().why, "reason 0") << "the best sequence's";
    EXPECT_EQ(sequence.error().where, first_place);
  }
}

TEST_F(CertificateJudge, AnObjectionToTheStartLeavesNothing) {
  BaseCoordinates begin;
  begin << -7.5, 0.0, 0.95, 0.0, 0.0, 0.0;
  int told = 0;
  const auto sequence =
      certifier_.certify(path_, begin, [&](const CertifiedSequence&) -> std::optional<Objection> {
        ++told;
        return Objection{0, "cannot start like this"};
      });
  ASSERT_FALSE(sequence);
  EXPECT_EQ(told, 1) << "there is no other way to begin";
  EXPECT_EQ(sequence.error().why, "cannot start like this");
}

}  // namespace
}  // namespace wex

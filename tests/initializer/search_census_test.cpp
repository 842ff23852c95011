#include "initializer/search_census.hpp"

#include <gmock/gmock.h>

namespace wex {
namespace {

using testing::Eq;
using testing::HasSubstr;
using testing::Not;

TEST(SearchCensus, CountsEveryReasonMostFrequentFirst) {
  SearchCensus census;
  for (int i = 0; i < 10; ++i) census.count_pose();
  for (int i = 0; i < 5; ++i) census.count(Rejection::kUntraversable);
  for (int i = 0; i < 2; ++i) census.count_askew();
  census.count_unsupported();
  for (int i = 0; i < 2; ++i) census.count(Rejection::kNone);
  EXPECT_THAT(census.sentence(),
              Eq("8 of 10 poses tried were rejected: a wheel on untraversable ground 62 %, heading "
                 "askew at what must be stepped over 25 %, no wheels and bucket to stand on 12 %"));
}

TEST(SearchCensus, AcceptedPosesAreNoReason) {
  SearchCensus census;
  census.count_pose();
  census.count(Rejection::kNone);
  EXPECT_EQ(census.sentence(), "0 of 1 poses tried were rejected");
}

TEST(SearchCensus, EveryRejectionHasItsName) {
  for (std::size_t i = 1; i < kNumRejections; ++i) {
    SearchCensus census;
    census.count_pose();
    census.count(static_cast<Rejection>(i));
    EXPECT_THAT(census.sentence(), HasSubstr(describe(static_cast<Rejection>(i)) + " 100 %"));
    EXPECT_THAT(census.sentence(), Not(HasSubstr("unnamed")));
  }
}

TEST(SearchCensus, TellsOfPathsThatFailedAndWhyMostDid) {
  SearchCensus census;
  census.count_pose();
  census.count_blocked();
  census.add({{1.0, 2.0, 0.0}, "wheel LF finds no ground", true});
  census.add({{3.0, 2.0, 0.0}, "the bucket is out of reach", true});
  census.add({{3.5, 2.0, 0.0}, "the bucket is out of reach", true});
  census.add({{4.0, 2.0, 0.0}, "wheel RH finds no ground", true});
  EXPECT_THAT(census.sentence(),
              Eq("1 of 1 poses tried were rejected: near a place where a path failed 100 %; 4 "
                 "path(s) could not be followed with the whole body, most often (2) because the "
                 "bucket is out of reach"));
  ASSERT_EQ(census.failed_paths().size(), 4U);
  EXPECT_EQ(census.failed_paths().front().where.x_m, 1.0);
}

TEST(SearchCensus, GathersFailuresByPlaceAndKind) {
  SearchCensus census;
  census.add({{0.0, 0.0, 0.0}, "once", true});
  census.add({{5.0, 0.0, 0.0}, "first", true});
  census.add({{5.3, 0.0, 1.0}, "second", true});
  census.add({{5.0, 0.0, 0.0}, "on four wheels", false});
  const auto places = census.failed_places();
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(places[0].count, 2);
  EXPECT_EQ(places[0].last.why, "second");
  EXPECT_EQ(places[1].last.why, "once");
  EXPECT_FALSE(places[2].last.stepping);
}

TEST(SearchCensus, ASearchMayHaveReasonsOfItsOwn) {
  SearchCensus census;
  census.count_poses(10);
  census.count("no contact for the bucket", 1);
  census.count("a swing leg without clearance", 3);
  census.count("too much tilt", 0);
  EXPECT_THAT(
      census.sentence(),
      Eq("4 of 10 poses tried were rejected: a swing leg without clearance 75 %, no contact "
         "for the bucket 25 %"));
}

TEST(SearchCensus, NothingTriedIsSaidToo) {
  EXPECT_EQ(SearchCensus{}.sentence(), "0 of 0 poses tried were rejected");
}

}  // namespace
}  // namespace wex

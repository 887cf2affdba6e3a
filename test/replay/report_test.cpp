#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "console/html_page.h"
#include "replay/report/packed_array.h"
#include "replay/report/report_errors.h"
#include "replay/report/report_page.h"
#include "replay/report/report_verdict.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kMillisecond;
using test::kSecond;
using test::kStart;
using testing::HasSubstr;
using testing::Not;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Of the examples of RFC 4648, section 10.
TEST(PackedArray, IsBase64OfLittleEndianNumbers) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(packed(Bytes{})["data"], "");
  EXPECT_EQ(packed(Bytes{'f'})["data"], "Zg==");
  EXPECT_EQ(packed(Bytes{'f', 'o'})["data"], "Zm8=");
  EXPECT_EQ(packed(Bytes{'f', 'o', 'o'})["data"], "Zm9v");
  EXPECT_EQ(packed(Bytes{'f', 'o', 'o', 'b'})["data"], "Zm9vYg==");
  EXPECT_EQ(packed(Bytes{'f', 'o', 'o', 'b', 'a', 'r'})["data"], "Zm9vYmFy");
  EXPECT_EQ(packed(std::vector<std::uint16_t>{0x6f66}), packed(Bytes{'f', 'o'}).patch(R"([
    {"op": "replace", "path": "/type", "value": "u16"}])"_json));
  EXPECT_EQ(packed(std::vector<float>{1.0F})["data"], packed(Bytes{0, 0, 0x80, 0x3f})["data"]);
}

TEST(PackedArray, KeepsSmallDifferencesOfLargeValues) {
  const nlohmann::json json =
      packed(std::vector<double>{4e5, 4e5 + 0x1p-10, kInfinite, kNotANumber});
  EXPECT_DOUBLE_EQ(json["offset"].get<double>(), 4e5 + 0x1p-11);
  const float half = 0x1p-11F;
  EXPECT_EQ(json["data"],
            packed(std::vector<float>{-half, half, std::nanf(""), std::nanf("")})["data"]);
  // Nor do the largest numbers there are overflow.
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(packed(std::vector<double>{-largest, largest})["offset"], 0.0);
}

TEST(PackedTime, CountsMicrosecondsOrWhatARunAsksFor) {
  const PackedTime hour = PackedTime::of_run(kStart, kStart + 3600 * kSecond);
  EXPECT_EQ(hour.unit, 1000);
  EXPECT_EQ(hour(kStart + 1'500), 2U);
  EXPECT_EQ(hour(kStart - kSecond), 0U);
  const PackedTime week = PackedTime::of_run(kStart, kStart + 7 * 24 * 3600 * kSecond);
  EXPECT_GT(week.unit, 1000);
  const double found = to_seconds(week.unit) * week(kStart + 7 * 24 * 3600 * kSecond);
  EXPECT_NEAR(found, 7 * 24 * 3600.0, 1e-3);
  EXPECT_EQ(week(std::numeric_limits<Stamp>::max() / 2), std::numeric_limits<std::uint32_t>::max());
}

TEST(ThinnedSeries, KeepsTheLeastAndTheLargest) {
  const std::vector<double> values = {1, 5, 3, -2, 7, kInfinite, 4};
  EXPECT_EQ(ThinnedSeries(1).values(values), (nlohmann::json{{"low", packed(values)}}));
  const nlohmann::json thinned = ThinnedSeries(3).values(values);
  EXPECT_EQ(thinned["low"], packed(std::vector<double>{1, kNotANumber, 4}));
  EXPECT_EQ(thinned["high"], packed(std::vector<double>{5, kNotANumber, 4}));
  const PackedTime time = PackedTime::of_run(kStart, kStart + kSecond);
  std::vector<Stamp> stamps;
  for (int i = 0; i < 7; ++i) stamps.push_back(kStart + i * kMillisecond);
  EXPECT_EQ(ThinnedSeries(3).times(stamps, time),
            packed(std::vector<std::uint32_t>{0, 3000, 6000}));
}

RunRecord::Compared at_each_second(std::size_t count) {
  RunRecord::Compared compared;
  for (std::size_t i = 0; i < count; ++i) {
    compared.stamps.push_back(kStart + static_cast<Duration>(i) * kSecond);
    compared.counted.push_back(true);
  }
  return compared;
}

TEST(ErrorFigures, TellWhenAnErrorHasSettled) {
  RunRecord::Compared compared = at_each_second(11);
  // In the end it is 0.1 at most, and so stays within 0.2 from the fourth stamp on.
  const std::vector<double> errors = {8, -4, 2, -0.2, 0.1, 0.15, -0.1, 0.1, 0.05, 0.1, -0.1};
  ErrorFigures figures = error_figures(compared, errors);
  EXPECT_EQ(figures.largest, 8.0);
  // 5 % of the largest is more than twice 0.15.
  EXPECT_EQ(figures.settled_within, 0.4);
  EXPECT_EQ(figures.settling_time, 3.0);

  // What is not counted is no error, but tells when the others have settled.
  compared.counted[0] = compared.counted[1] = false;
  figures = error_figures(compared, errors);
  EXPECT_EQ(figures.largest, 2.0);
  EXPECT_EQ(figures.settling_time, 3.0);
}

TEST(ErrorFigures, OfAnErrorThatGrowsOrIsThereFromTheStart) {
  EXPECT_EQ(error_figures(at_each_second(4), {1, 1, 1, 1}).settling_time, 0.0);
  EXPECT_EQ(error_figures(at_each_second(4), {0, 0, 0, 0}).settling_time, 0.0);
  EXPECT_EQ(error_figures(at_each_second(0), {}).largest, std::nullopt);
  // An error that is no number never settles.
  EXPECT_EQ(error_figures(at_each_second(2), {0, kNotANumber}).settling_time, std::nullopt);
}

std::vector<std::string> warnings_of(const ReplaySummary& summary) {
  std::vector<std::string> texts;
  for (const ReportFinding& finding : verdict_of(summary, ErrorFigures(), "")) {
    if (finding.level == FindingLevel::kWarning) texts.push_back(finding.text);
  }
  return texts;
}

TEST(ReportVerdict, NamesWhatMakesAnEstimateDoubtful) {
  ReplaySummary summary;
  summary.estimates = 500;
  EXPECT_TRUE(warnings_of(summary).empty());
  summary.input_stale = 176;
  summary.input_stale_since = 12.5;
  summary.latencies["gps"] = -3.1;
  summary.stamped_ahead = {"gps"};
  EXPECT_THAT(warnings_of(summary),
              testing::ElementsAre("176 of 500 estimates rest on an input older than its timeout, "
                                   "from 12.500 s on",
                                   HasSubstr("Stamps of gps are 3.1")));
}

TEST(ReportVerdict, ComparesInnovationsWithTheirCovariance) {
  for (const double nis : {0.1, 1.0, 2.0, 5.0, 200.0}) {
    ReplaySummary summary;
    summary.innovations.push_back({"gps", 2, {}});
    InnovationStatistics& innovations = summary.innovations.front().of;
    innovations.count = innovations.nis_count = 100;
    innovations.nis_sum = 100.0 * nis;
    const std::vector<std::string> found = warnings_of(summary);
    if (nis > 0.5 && nis < 6.0) {
      EXPECT_TRUE(found.empty()) << nis;
    } else {
      EXPECT_THAT(found, testing::ElementsAre(HasSubstr(nis > 2.0 ? "gps are larger than"
                                                                  : "gps are smaller than")));
    }
    innovations.nis_count = 10;
    innovations.nis_sum = 10.0 * nis;
    EXPECT_TRUE(warnings_of(summary).empty()) << "by few";
  }
}

TEST(ReportPage, HoldsNoMarkupOfItsData) {
  const std::string page =
      html_page({{"bag", "</script><!-- /* STYLE */ /* DATA */ \xff"}, {"observer", "x"}},
                page_parts::report());
  EXPECT_THAT(page, HasSubstr(R"("bag":"\u003c/script>\u003c!-- /* STYLE */ /* DATA */ )"));
  EXPECT_THAT(page, Not(HasSubstr("/* SCRIPT */")));
}

}  // namespace
}  // namespace sampled_data_observers

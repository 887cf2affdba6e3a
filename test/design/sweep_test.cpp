#include "design/sweep.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "files/csv.h"

namespace sampled_data_observers {
namespace {

SweepPoint point(const std::string& method, double T2, std::optional<double> value) {
  SweepPoint result;
  result.method = method;
  result.T2 = T2;
  result.value = value;
  return result;
}

TEST(BestCurves, LetTheDesignForALargerT2ServeWhereItIsBetter) {
  // As they come from workers: in any order. The solver failed at 0.2 and did badly at 0.3.
  const std::vector<SweepPoint> points = {point("b", 0.1, 7.0),          point("a", 0.4, 5.0),
                                          point("a", 0.2, std::nullopt), point("a", 0.1, 1.0),
                                          point("a", 0.5, std::nullopt), point("a", 0.3, 6.0)};
  const std::vector<CurvePoint> curves = best_curves(points, Objective::kMinGamma);
  ASSERT_EQ(curves.size(), 6u);
  EXPECT_EQ(curves[0].design.value, 1.0);
  for (int i : {1, 2, 3}) {
    EXPECT_DOUBLE_EQ(curves[i].T2, 0.1 * (i + 1)) << i;
    EXPECT_EQ(curves[i].design.value, 5.0) << i;
    EXPECT_EQ(curves[i].design.T2, 0.4) << i;
  }
  EXPECT_EQ(curves[4].design.value, std::nullopt);
  EXPECT_EQ(curves[5].method, "b");
}

TEST(BestCurves, OfRatesFall) {
  const std::vector<SweepPoint> points = {point("a", 1.0, 0.3), point("a", 2.0, 0.4),
                                          point("a", 3.0, 0.1)};
  const std::vector<CurvePoint> curves = best_curves(points, Objective::kMaxDecay);
  EXPECT_EQ(curves[0].design.value, 0.4);
  EXPECT_EQ(curves[1].design.value, 0.4);
  EXPECT_EQ(curves[2].design.value, 0.1);
}

TEST(SweepTimes, AreEquidistantAndShort) {
  EXPECT_EQ(sweep_times(0.1, 0.4, 4), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(sweep_times(0.1, 0.4, 1), (std::vector<double>{0.4}));
  EXPECT_THROW(sweep_times(0.4, 0.1, 3), DesignError);
  EXPECT_THROW(sweep_times(0.0, 0.1, 3), DesignError);
  EXPECT_THROW(sweep_times(1.0, 1.0 + 1e-9, 3), DesignError);
  EXPECT_THROW(sweep_times(1.0, std::numeric_limits<double>::quiet_NaN(), 3), DesignError);
}

TEST(Csv, ReadsWhatItWrites) {
  const std::vector<std::string> fields = {"a", "", "1,5", "say \"no\"", "x"};
  EXPECT_EQ(csv_line(fields), "a,,\"1,5\",\"say \"\"no\"\"\",x");
  EXPECT_EQ(csv_fields(csv_line(fields)), fields);
  EXPECT_EQ(csv_fields(csv_line({"two\nlines"})), std::vector<std::string>{"two; lines"});
  EXPECT_THROW(csv_fields("a,\"b"), std::invalid_argument);
}

TEST(Csv, NumbersAreReadAsTheSame) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 123456789.123456789, -2.5e17}) {
    EXPECT_EQ(std::stod(shortest_decimal(value)), value);
  }
  EXPECT_EQ(shortest_decimal(0.41), "0.41");
}

}  // namespace
}  // namespace sampled_data_observers

#include "console/option_checks.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

TEST(OptionChecks, AcceptFiniteNumbersWithinTheirBoundsOnly) {
  EXPECT_EQ("", number_above(0.0)("1e-300"));
  EXPECT_EQ("expected a number > 0, found 0", number_above(0.0)("0"));
  EXPECT_EQ("", number_at_least(0.0)("0"));
  EXPECT_EQ("expected a number >= 0, found -1", number_at_least(0.0)("-1"));
  EXPECT_EQ("", number_between(0.5, 2.0)("0.5"));
  EXPECT_EQ("", number_between(0.5, 2.0)("2"));
  EXPECT_EQ("expected a number from 0.5 to 2, found 2.1", number_between(0.5, 2.0)("2.1"));
  for (const char* text : {"nan", "-nan", "inf", "1e999", "x", "1 s", "1,5"}) {
    EXPECT_EQ(std::string("expected a number >= 0, found ") + text, number_at_least(0.0)(text));
  }
  EXPECT_EQ("expected a number >= 0, found nothing", number_at_least(0.0)(""));
  EXPECT_EQ("", any_number()("-1e300"));
  EXPECT_EQ("expected a number, found inf", any_number()("inf"));
}

TEST(OptionChecks, AcceptWholeNumbersThatFit) {
  EXPECT_EQ("", whole_number_at_least(0)("0"));
  EXPECT_EQ("", whole_number_at_least(0)("18446744073709551615"));
  EXPECT_EQ("expected a whole number >= 1, found 0", whole_number_at_least(1)("0"));
  EXPECT_EQ("", whole_number_between(1, 20)("20"));
  EXPECT_EQ("expected a whole number from 1 to 20, found 21", whole_number_between(1, 20)("21"));
  for (const char* text : {"-3", "+3", "1.5", "nan", "18446744073709551616"}) {
    EXPECT_NE("", whole_number_at_least(0)(text)) << text;
  }
}

TEST(OptionChecks, AcceptChoicesByTheirWholeName) {
  EXPECT_EQ("", one_of({"curve", "point"})("point"));
  EXPECT_EQ("expected one of curve, point, found poin", one_of({"curve", "point"})("poin"));
  EXPECT_EQ("expected curve, found nothing", one_of({"curve"})(""));
}

TEST(OptionChecks, AcceptPicturesByTheirEnding) {
  EXPECT_EQ("", picture_file()("a.b/c.png"));
  EXPECT_EQ("", picture_file()("c.svg"));
  EXPECT_EQ("", picture_file()("c.pdf"));
  for (const char* path : {"c.gif", "png", ".png", "c.png.txt"}) {
    EXPECT_NE("", picture_file()(path)) << path;
  }
}

}  // namespace
}  // namespace sampled_data_observers

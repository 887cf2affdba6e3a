#include "console/help_page.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

TEST(HelpPage, HasTwoColumnsAndBreaksLinesBetweenWords) {
  HelpPage page;
  page.usage = "tool FILE";
  page.description = "Does what it does.";
  page.sections = {
      {"Arguments", {{"FILE", "To read"}}},
      {"Commands", {}},
      {"Options",
       {{"--a-name-that-fills-the-column", "Stands above its text"},
        {"--method",
         "How, and this goes on until no further word fits into the line of a terminal:\n"
         "  first: what has so much to be said of it that one line is not enough\n"
         "  second"}}}};
  page.footer = "Exit status: 0 done.";
  EXPECT_EQ(
      "Usage: tool FILE\n"
      "\n"
      "Does what it does.\n"
      "\n"
      "Arguments:\n"
      "  FILE                      To read\n"
      "\n"
      "Options:\n"
      "  --a-name-that-fills-the-column\n"
      "                            Stands above its text\n"
      "  --method                  How, and this goes on until no further word fits into the line "
      "of a\n"
      "                            terminal:\n"
      "                              first: what has so much to be said of it that one line is "
      "not\n"
      "                                enough\n"
      "                              second\n"
      "\n"
      "Exit status: 0 done.\n",
      laid_out(page));
}

TEST(HelpPage, KeepsAWordThatIsLongerThanALine) {
  HelpPage page;
  page.description = "before " + std::string(100, 'x') + " after";
  EXPECT_NE(std::string::npos,
            laid_out(page).find("before\n" + std::string(100, 'x') + "\nafter\n"));
}

}  // namespace
}  // namespace sampled_data_observers

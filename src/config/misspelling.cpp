#include "config/misspelling.h"

#include <algorithm>
#include <cctype>

namespace sampled_data_observers {
namespace {

/// Longer words are nobody's keys, and cost the square of their length.
constexpr std::size_t kLongestWord = 64;
constexpr std::size_t kLettersPerMistake = 4;

/// How many letters must be left out, added, replaced, or exchanged with their neighbours to make
/// one word of the other (optimal string alignment).
std::size_t mistakes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
    before_last.swap(last);
    last.swap(current);
  }
  return last[b.size()];
}

bool differ_by_last_letter(const std::string& a, const std::string& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end() - 1, b.begin());
}

/// Of one letter the case may be meant: q and Q.
bool differ_by_case(const std::string& a, const std::string& b) {
  const auto is_same = [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  };
  return a.size() > 1 && std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
}

}  // namespace

std::string misspelling_of(const std::string& word, const std::vector<std::string>& among) {
  if (word.empty() || word.size() > kLongestWord) return "";
  const std::size_t most = word.size() / kLettersPerMistake;
  for (const std::string& candidate : among) {
    if (differ_by_case(word, candidate)) return candidate;
    if (candidate.size() > kLongestWord || differ_by_last_letter(word, candidate)) continue;
    if (mistakes_between(word, candidate) <= most) return candidate;
  }
  return "";
}

}  // namespace sampled_data_observers

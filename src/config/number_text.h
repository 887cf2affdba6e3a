#pragma once

#include <locale>
#include <sstream>
#include <string>

namespace sampled_data_observers {

/// A number for a message, with a decimal point whatever the locale.
inline std::string number_text(double value, int digits = 6) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(digits);
  text << value;
  return text.str();
}

}  // namespace sampled_data_observers

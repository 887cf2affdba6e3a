#include "messages/other_definition.h"

#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {
namespace {

/// Of the names within: four of them, and two sums of 32 characters, fit into kLongestDetail.
constexpr std::size_t kLongestName = 70;

std::string said(const ros::M_string& connection, const char* key) {
  const auto found = connection.find(key);
  return found == connection.end() ? "unknown" : found->second.substr(0, kLongestName);
}

}  // namespace

std::string describe_other_definition(const std::string& topic, const ros::M_string& connection,
                                      const std::string& type, const std::string& md5sum) {
  const std::string text = said(connection, "callerid") + " on " + topic.substr(0, kLongestName) +
                           " has " + said(connection, "type") + ", MD5 sum " +
                           said(connection, "md5sum") + "; expected " +
                           type.substr(0, kLongestName) + ", " + md5sum;
  return text.substr(0, kLongestDetail);
}

}  // namespace sampled_data_observers

#include "linear_algebra/shared_tables.h"

#include <malloc.h>

#include <map>
#include <mutex>
#include <utility>

namespace sampled_data_observers {
namespace {

using Tables = std::shared_ptr<const std::vector<double>>;

/// The tables that somebody has.
class KnownTables {
 public:
  Tables find(const std::vector<double>& key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = tables_.find(key);
    return found == tables_.end() ? nullptr : found->second.lock();
  }

  /// Returns those that another thread has made meanwhile, if any, else these.
  Tables add(std::vector<double> key, const Tables& made) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto entry = tables_.begin(); entry != tables_.end();) {
      entry = entry->second.expired() ? tables_.erase(entry) : std::next(entry);
    }
    std::weak_ptr<const std::vector<double>>& entry = tables_[std::move(key)];
    Tables known = entry.lock();
    if (!known) entry = known = made;
    return known;
  }

 private:
  std::mutex mutex_;
  std::map<std::vector<double>, std::weak_ptr<const std::vector<double>>> tables_;
};

KnownTables& known_tables() {
  static KnownTables known;
  return known;
}

}  // namespace

Tables shared_tables(std::vector<double> key, const std::function<std::vector<double>()>& make) {
  Tables tables = known_tables().find(key);
  if (tables) return tables;
  tables = std::make_shared<const std::vector<double>>(make());
  // What they were made of, as much again, goes back to the system where it is worth the while.
  constexpr std::size_t kLarge = 1U << 17U;
  if (tables->size() >= kLarge) ::malloc_trim(0);
  return known_tables().add(std::move(key), tables);
}

}  // namespace sampled_data_observers

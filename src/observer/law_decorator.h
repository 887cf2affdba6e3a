#pragma once

#include <memory>
#include <utility>

#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers {

/// A law that changes how another one takes its events. Its state is the other's, with some slots
/// of its own behind.
class LawDecorator : public ObserverLaw {
 public:
  bool accepts(const Event& event) const override { return law_->accepts(event); }

 protected:
  explicit LawDecorator(std::shared_ptr<const ObserverLaw> law)
      : ObserverLaw(*law), law_(std::move(law)) {}

  const ObserverLaw& law() const { return *law_; }

 private:
  std::shared_ptr<const ObserverLaw> law_;
};

}  // namespace sampled_data_observers

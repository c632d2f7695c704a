// Which descriptors of a list are in scope, asked one by one and answered once.
#pragma once

#include <cstdint>
#include <vector>

#include "core/map/descriptor_index.h"

namespace lodemark {

class DescriptorScope {
 public:
  // For the list to be visited now. Both must outlive the visit.
  void Enter(const SearchScope& scope, const DescriptorListView& view);

  bool Admits(std::size_t i) {
    if (!limited_) return true;
    if (answers_[i] == kUnknown) answers_[i] = Ask(i) ? kIn : kOut;
    return answers_[i] == kIn;
  }

 private:
  enum Answer : std::uint8_t { kUnknown, kIn, kOut };

  bool Ask(std::size_t i) const;

  const SearchScope* scope_ = nullptr;
  const DescriptorListView* view_ = nullptr;
  bool limited_ = false;
  float cos_widest_turn_ = 1.0F;
  float sin_widest_turn_ = 0.0F;
  std::vector<std::uint8_t> answers_;  // room is kept from list to list
};

}  // namespace lodemark

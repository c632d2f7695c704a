// A list whose elements keep their numbers while the oldest of them are given up.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lodemark {

template <typename Element>
class NumberedList {
 public:
  // For one more, so that pushing it takes no memory.
  void MakeRoom() {
    if (elements_.size() < elements_.capacity()) return;
    elements_.reserve(2 * elements_.capacity() + 16);
  }
  void Push(Element element) { elements_.push_back(std::move(element)); }

  // Of the oldest that is held, and one beyond the newest.
  std::size_t first() const { return given_up_ + gone_; }
  std::size_t end() const { return given_up_ + elements_.size(); }
  bool empty() const { return first() == end(); }
  bool Has(std::size_t number) const { return number >= first() && number < end(); }
  Element& operator[](std::size_t number) { return elements_[number - given_up_]; }
  const Element& operator[](std::size_t number) const { return elements_[number - given_up_]; }
  // The first has the number first().
  std::span<const Element> all() const {
    return std::span<const Element>(elements_).subspan(gone_);
  }

  // Each element is moved once on average.
  void GiveUpBefore(std::size_t number) {
    while (first() < end() && first() < number) ++gone_;
    if (2 * gone_ < elements_.size()) return;
    elements_.erase(elements_.begin(), elements_.begin() + static_cast<std::ptrdiff_t>(gone_));
    given_up_ += gone_;
    gone_ = 0;
  }
  // As if those from the number on had not come; a number that was given up already gives up all.
  void CutFrom(std::size_t number) {
    if (number >= end()) return;
    const std::size_t kept = number > first() ? number - given_up_ : gone_;
    elements_.erase(elements_.begin() + static_cast<std::ptrdiff_t>(kept), elements_.end());
  }
  void Clear() { *this = NumberedList(); }

 private:
  std::vector<Element> elements_;
  std::size_t gone_ = 0;      // of these, from the front
  std::size_t given_up_ = 0;  // before these
};

}  // namespace lodemark

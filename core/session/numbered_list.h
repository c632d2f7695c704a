// A list that is known by the numbers of its elements: it can be cut, and makes room for an element
// before it comes.
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

  std::size_t end() const { return elements_.size(); }  // one beyond the newest
  bool empty() const { return elements_.empty(); }
  bool Has(std::size_t number) const { return number < end(); }
  Element& operator[](std::size_t number) { return elements_[number]; }
  const Element& operator[](std::size_t number) const { return elements_[number]; }
  std::span<const Element> all() const { return elements_; }

  // As if those from the number on had not come.
  void CutFrom(std::size_t number) {
    if (number < end()) {
      elements_.erase(elements_.begin() + static_cast<std::ptrdiff_t>(number), elements_.end());
    }
  }
  void Clear() { elements_.clear(); }

 private:
  std::vector<Element> elements_;
};

}  // namespace lodemark

// How many views something is of.
#pragma once
#include <algorithm>
#include <set>
#include <vector>

namespace ibrdf {

// The number of views of items with a `view`, as ShadingPoint has it; at least
// 1.
template <typename Item>
int NumViews(const std::vector<Item>& items) {
  std::set<int> views;
  for (const Item& item : items) views.insert(item.view);
  return std::max(1, static_cast<int>(views.size()));
}

}  // namespace ibrdf

#include "tools/fields/max_flow.h"

#include <algorithm>

namespace hoof::tools {

void MaxFlow::add_edge(int a, int b, std::int64_t capacity) {
  edges_.push_back({b, first_[std::size_t(a)], capacity});
  first_[std::size_t(a)] = int(edges_.size()) - 1;
  edges_.push_back({a, first_[std::size_t(b)], capacity});
  first_[std::size_t(b)] = int(edges_.size()) - 1;
}

bool MaxFlow::find_levels(int source, int sink) {
  level_.assign(first_.size(), -1);
  level_[std::size_t(source)] = 0;
  std::vector<int> reached = {source};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const int node = reached[i];
    for (int e = first_[std::size_t(node)]; e >= 0; e = edges_[std::size_t(e)].next) {
      const Edge& edge = edges_[std::size_t(e)];
      if (edge.left == 0 || level_[std::size_t(edge.to)] >= 0) continue;
      level_[std::size_t(edge.to)] = level_[std::size_t(node)] + 1;
      reached.push_back(edge.to);
    }
  }
  return level_[std::size_t(sink)] >= 0;
}

/// One path along rising levels; the way is kept in a list, as chains of grains may be long.
std::int64_t MaxFlow::push(int source, int sink) {
  std::vector<int> way;  // edges
  int node = source;
  while (node != sink) {
    int& e = at_[std::size_t(node)];
    const auto goes_on = [&](const Edge& edge) {
      return edge.left > 0 && level_[std::size_t(edge.to)] == level_[std::size_t(node)] + 1;
    };
    while (e >= 0 && !goes_on(edges_[std::size_t(e)])) e = edges_[std::size_t(e)].next;
    if (e >= 0) {
      way.push_back(e);
      node = edges_[std::size_t(e)].to;
      continue;
    }
    if (way.empty()) return 0;
    node = edges_[std::size_t(way.back() ^ 1)].to;  // a dead end: back, and never in again
    int& from = at_[std::size_t(node)];
    from = edges_[std::size_t(from)].next;
    way.pop_back();
  }
  std::int64_t flow = edges_[std::size_t(way.front())].left;
  for (const int e : way) flow = std::min(flow, edges_[std::size_t(e)].left);
  for (const int e : way) {
    edges_[std::size_t(e)].left -= flow;
    edges_[std::size_t(e ^ 1)].left += flow;
  }
  return flow;
}

std::int64_t MaxFlow::between(int source, int sink) {
  std::int64_t flow = 0;
  while (find_levels(source, sink)) {
    at_ = first_;
    while (const std::int64_t more = push(source, sink)) flow += more;
  }
  return flow;
}

}  // namespace hoof::tools

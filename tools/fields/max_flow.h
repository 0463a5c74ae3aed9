// The largest flow from one node of an undirected graph to another.
#pragma once

#include <cstdint>
#include <vector>

namespace hoof::tools {

/// Dinic's method (E. A. Dinic, Soviet Math. Dokl. 11, 1970, 1277-1280). Capacities are whole
/// numbers, so that the answer is exact. With capacities of one it is the number of paths that
/// share no edge (Menger's theorem).
class MaxFlow {
 public:
  explicit MaxFlow(int nodes) : first_(std::size_t(nodes), -1) {}

  void add_edge(int a, int b, std::int64_t capacity);  // either way
  /// Once.
  std::int64_t between(int source, int sink);

 private:
  struct Edge {
    int to, next;
    std::int64_t left;
  };
  bool find_levels(int source, int sink);
  std::int64_t push(int source, int sink);

  std::vector<int> first_, level_, at_;
  std::vector<Edge> edges_;  // an edge and its way back lie side by side
};

}  // namespace hoof::tools

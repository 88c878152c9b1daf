#include "collision/contour/lockstep_flood.hpp"

#include <utility>

namespace selvedge {

LockstepFlood::~LockstepFlood() {
  for (const std::vector<int>& vertices : reached_)
    for (const int v : vertices) owner_[v] = -1;
}

int LockstepFlood::add_front() {
  parent_.push_back(count());
  waiting_.emplace_back();
  reached_.emplace_back();
  return count() - 1;
}

int LockstepFlood::root(int front) {
  while (parent_[front] != front) front = parent_[front] = parent_[parent_[front]];
  return front;
}

void LockstepFlood::seed(int vertex, int front) { reach(vertex, root(front)); }

void LockstepFlood::join(int a, int b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  if (a > b) std::swap(a, b);
  parent_[b] = a;
  for (auto* lists : {&waiting_, &reached_}) {
    if ((*lists)[a].size() < (*lists)[b].size()) std::swap((*lists)[a], (*lists)[b]);
    (*lists)[a].insert((*lists)[a].end(), (*lists)[b].begin(), (*lists)[b].end());
    (*lists)[b] = {};
  }
}

void LockstepFlood::reach(int vertex, int front) {
  if (owner_[vertex] >= 0) {
    join(owner_[vertex], front);
    return;
  }
  owner_[vertex] = front;
  waiting_[front].push_back(vertex);
  reached_[front].push_back(vertex);
}

void LockstepFlood::expand(int front) {
  const int v = waiting_[front].back();
  waiting_[front].pop_back();
  for (const int t : surface_.triangles_of(v))
    for (int k = 0; k < 3; ++k) {
      const int edge = surface_.triangle_edges(t, k), a = surface_.edges(edge, 0), b = surface_.edges(edge, 1);
      if ((a == v || b == v) && !shut_[edge]) reach(a == v ? b : a, root(front));
    }
}

int LockstepFlood::grow(int open) {
  std::vector<int> growing;
  for (;;) {
    growing.clear();
    for (int f = 0; f < count(); ++f)
      if (parent_[f] == f && !waiting_[f].empty()) growing.push_back(f);
    if (static_cast<int>(growing.size()) <= open) return growing.empty() ? -1 : growing.front();
    // The list stays valid until a front ends or joins another.
    for (bool same = true; same;)
      for (const int f : growing) {
        if (parent_[f] != f || waiting_[f].empty()) {
          same = false;
          continue;
        }
        expand(f);
      }
  }
}

std::vector<int> two_colours(int fronts, std::span<const std::array<int, 2>> joined, int start) {
  std::vector<std::vector<int>> beside(static_cast<std::size_t>(fronts));
  for (const auto& [a, b] : joined) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<int> colour(beside.size(), -1);
  const auto spread = [&](int from) {
    if (colour[from] >= 0) return true;
    colour[from] = 0;
    for (std::vector<int> stack{from}; !stack.empty();) {
      const int at = stack.back();
      stack.pop_back();
      for (const int next : beside[at]) {
        if (colour[next] == colour[at]) return false;
        if (colour[next] >= 0) continue;
        colour[next] = 1 - colour[at];
        stack.push_back(next);
      }
    }
    return true;
  };
  bool fits = start < 0 || spread(start);
  for (const auto& [a, b] : joined) fits = fits && spread(a) && spread(b);
  return fits ? colour : std::vector<int>();
}

}  // namespace selvedge

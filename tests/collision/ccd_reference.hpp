#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "collision/exact/exact_integer.hpp"
#include "collision/exact/moving_polygon.hpp"
#include "collision/geometry/points.hpp"

// Continuous detection by algebra, for coordinates that are small whole numbers. A contact can begin only at time 0 or
// at a root of one of a few polynomials; Sturm's chains and greatest common divisors give the signs of all others
// there. It is slow. It shares whole numbers with the tested code, but neither conditions nor method.
namespace selvedge::reference {

using Four = std::array<Vec3, 4>;

struct Polynomial {
  std::vector<ExactInteger> c;  // lowest degree first, last one not zero; empty: zero

  bool is_zero() const { return c.empty(); }
  std::size_t degree() const { return c.size() - 1; }
};

inline ExactInteger whole(double value) { return {value, 0}; }

inline Polynomial trimmed(std::vector<ExactInteger> c) {
  while (!c.empty() && c.back().sign() == 0) c.pop_back();
  return {std::move(c)};
}

inline Polynomial linear(double start, double end) { return trimmed({whole(start), whole(end - start)}); }

inline Polynomial combine(const Polynomial& a, const Polynomial& b, bool minus) {
  std::vector<ExactInteger> c(std::max(a.c.size(), b.c.size()));
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (i < a.c.size()) c[i] = a.c[i];
    if (i < b.c.size()) c[i] = minus ? c[i] - b.c[i] : c[i] + b.c[i];
  }
  return trimmed(std::move(c));
}

inline Polynomial operator+(const Polynomial& a, const Polynomial& b) { return combine(a, b, false); }
inline Polynomial operator-(const Polynomial& a, const Polynomial& b) { return combine(a, b, true); }

inline Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.is_zero() || b.is_zero()) return {};
  std::vector<ExactInteger> c(a.c.size() + b.c.size() - 1);
  for (std::size_t i = 0; i < a.c.size(); ++i)
    for (std::size_t j = 0; j < b.c.size(); ++j) c[i + j] = c[i + j] + a.c[i] * b.c[j];
  return trimmed(std::move(c));
}

inline Polynomial derivative(const Polynomial& p) {
  std::vector<ExactInteger> c;
  for (std::size_t i = 1; i < p.c.size(); ++i) c.push_back(p.c[i] * whole(static_cast<double>(i)));
  return trimmed(std::move(c));
}

// A positive multiple of the remainder of a by b, b not zero.
inline Polynomial remainder(Polynomial a, const Polynomial& b) {
  const ExactInteger lead = b.c.back(), size = lead.sign() > 0 ? lead : whole(0) - lead;
  while (!a.is_zero() && a.degree() >= b.degree()) {
    const ExactInteger factor = lead.sign() > 0 ? a.c.back() : whole(0) - a.c.back();
    const std::size_t shift = a.degree() - b.degree();
    for (ExactInteger& value : a.c) value = value * size;
    for (std::size_t i = 0; i < b.c.size(); ++i) a.c[i + shift] = a.c[i + shift] - factor * b.c[i];
    a = trimmed(std::move(a.c));
  }
  return a;
}

inline Polynomial divisor(Polynomial a, Polynomial b) {
  while (!b.is_zero()) {
    Polynomial r = remainder(a, b);
    a = std::move(b);
    b = std::move(r);
  }
  return a;
}

// The sign at a double.
inline int sign_at(const Polynomial& p, double time) {
  const int exponent = std::min(0, lowest_exponent(time));
  const ExactInteger t(time, exponent), one(1, exponent);
  ExactInteger value, power(1, 0);
  std::vector<ExactInteger> powers{power};
  for (std::size_t i = 1; i < p.c.size(); ++i) powers.push_back(powers.back() * one);
  ExactInteger to_the_i(1, 0);
  for (std::size_t i = 0; i < p.c.size(); ++i) {
    value = value + p.c[i] * to_the_i * powers[p.degree() - i];
    to_the_i = to_the_i * t;
  }
  return value.sign();
}

// Sturm's theorem: the number of distinct roots between lo and hi, where p is not zero at either.
inline int count_roots(const Polynomial& p, double lo, double hi) {
  std::vector<Polynomial> chain{p, derivative(p)};
  while (!chain.back().is_zero()) {
    const Polynomial r = remainder(chain[chain.size() - 2], chain.back());
    chain.push_back(Polynomial{} - r);
  }
  const auto changes = [&](double time) {
    int count = 0, before = 0;
    for (const Polynomial& link : chain) {
      const int sign = link.is_zero() ? 0 : sign_at(link, time);
      if (sign == 0) continue;
      count += before * sign < 0;
      before = sign;
    }
    return count;
  };
  return changes(lo) - changes(hi);
}

// One root of a polynomial that is not zero at either end.
struct Root {
  Polynomial of;
  double lo, hi;
};

// A time inside the interval that is not a root.
inline double split(const Polynomial& p, double lo, double hi) {
  for (double part = 0.5;; part = part > 0.5 ? 1 - part + 0.0625 : 0.5 + (0.5 - part) + 0.0625) {
    const double at = lo + part * (hi - lo);
    if (sign_at(p, at) != 0) return at;
  }
}

inline void isolate(const Polynomial& p, double lo, double hi, std::vector<Root>& roots) {
  const int count = count_roots(p, lo, hi);
  if (count == 0) return;
  if (count == 1) {
    roots.push_back({p, lo, hi});
    return;
  }
  const double middle = split(p, lo, hi);
  isolate(p, lo, middle, roots);
  isolate(p, middle, hi, roots);
}

inline void halve(Root& r) {
  const double middle = split(r.of, r.lo, r.hi);
  (count_roots(r.of, r.lo, middle) == 1 ? r.hi : r.lo) = middle;
}

inline int sign_at(const Polynomial& p, Root r) {
  if (p.is_zero()) return 0;
  const Polynomial common = divisor(r.of, p);
  if (count_roots(common, r.lo, r.hi) > 0) return 0;
  while (sign_at(p, r.lo) == 0 || sign_at(p, r.hi) == 0 || count_roots(p, r.lo, r.hi) > 0) halve(r);
  return sign_at(p, r.lo);
}

using Moving = std::array<Polynomial, 3>;

inline Moving cross(const Moving& a, const Moving& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Polynomial dot(const Moving& a, const Moving& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The triangle a, b, c holds the origin if volume is zero, no product of turns is negative, and, where all turns are
// zero, some corners are on opposite sides of it or one is on it.
struct Triangle {
  Polynomial volume, any_turn;
  std::array<Polynomial, 3> turns, sides;
};

inline Triangle triangle(const Moving& a, const Moving& b, const Moving& c) {
  const Moving ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  return {dot(ab, c),
          dot(ab, ab) + dot(bc, bc) + dot(ca, ca),
          {dot(ab, bc), dot(bc, ca), dot(ca, ab)},
          {dot(a, b), dot(b, c), dot(c, a)}};
}

template <class Time>
bool holds_origin(const Triangle& t, const Time& at) {
  if (sign_at(t.volume, at) != 0) return false;
  for (const Polynomial& turn : t.turns)
    if (sign_at(turn, at) < 0) return false;
  if (sign_at(t.any_turn, at) != 0) return true;
  return std::any_of(t.sides.begin(), t.sides.end(), [&](const Polynomial& side) { return sign_at(side, at) <= 0; });
}

// The parallelogram of an edge pair as two triangles.
inline std::vector<Triangle> triangles(PairKind kind, const Four& x0, const Four& x1) {
  const auto difference = [&](int to, int from) {
    Moving m;
    for (int k = 0; k < 3; ++k) m[k] = linear(x0[to][k] - x0[from][k], x1[to][k] - x1[from][k]);
    return m;
  };
  if (kind == PairKind::vertex_face) return {triangle(difference(1, 0), difference(2, 0), difference(3, 0))};
  const Moving d00 = difference(2, 0), d01 = difference(3, 0), d10 = difference(2, 1), d11 = difference(3, 1);
  return {triangle(d00, d10, d11), triangle(d00, d11, d01)};
}

// The first time of contact: a root of a polynomial, 0 as the root of the polynomial t, or none.
inline std::optional<Root> first_contact(PairKind kind, const Four& x0, const Four& x1) {
  std::optional<Root> first;
  for (const Triangle& t : triangles(kind, x0, x1)) {
    if (holds_origin(t, 0.0)) return Root{linear(0, 1), -1, 1};
    std::vector<Polynomial> candidates{t.volume};
    if (t.volume.is_zero()) {
      candidates = {t.any_turn};
      candidates.insert(candidates.end(), t.turns.begin(), t.turns.end());
      candidates.insert(candidates.end(), t.sides.begin(), t.sides.end());
    }
    for (const Polynomial& p : candidates) {
      if (p.is_zero()) continue;
      // 1 may be a root itself, so the search goes beyond it and drops later roots.
      double lo = -0x1p-10, hi = 1 + 0x1p-10;
      while (sign_at(p, lo) == 0) lo *= 0.75;
      while (sign_at(p, hi) == 0) hi = 1 + 0.75 * (hi - 1);
      std::vector<Root> roots;
      isolate(p, lo, hi, roots);
      for (const Root& r : roots) {
        if (sign_at(linear(0, 1), r) < 0 || sign_at(linear(-1, 0), r) > 0 || !holds_origin(t, r)) continue;
        const auto before = [](Root a, Root b) {
          for (int i = 0; i < 40; ++i) {
            if (a.hi <= b.lo) return true;
            if (b.hi <= a.lo) return false;
            halve(a), halve(b);
          }
          return false;  // equal to twelve digits
        };
        if (!first || before(r, *first)) first = r;
      }
    }
  }
  return first;
}

// Whether `time` is at or before the root, by at most `early`.
inline bool is_just_before(double time, Root r, double early) {
  if (time > r.lo && time < r.hi) {
    if (sign_at(r.of, time) != 0 && count_roots(r.of, r.lo, time) > 0) return false;
  } else if (time >= r.hi) {
    return false;
  }
  while (r.hi - r.lo > 0.25 * early) halve(r);
  return r.hi - time <= early;
}

}  // namespace selvedge::reference

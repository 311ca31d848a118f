#include "mesh/pattern/delaunay.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "mesh/base/predicates.h"

namespace drape::internal {
namespace {

std::size_t z(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Delaunay::Delaunay(const Eigen::AlignedBox2d& box) {
  const Vec2 middle = box.center();
  const double reach = 10 * box.diagonal().norm();
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    points_.push_back(middle + reach * Vec2(x, y));
  faces_ = {{{0, 1, 2}, {-1, 1, -1}, {-1, -1, -1}}, {{0, 2, 3}, {-1, -1, 0}, {-1, -1, -1}}};
  face_at_ = {0, 0, 0, 1};
}

int Delaunay::new_vertex(const Vec2& x) {
  points_.push_back(x);
  face_at_.push_back(-1);
  return static_cast<int>(points_.size()) - 1;
}

// The corner opposite the same edge in the triangle on the other side of it.
Delaunay::Corner Delaunay::across(Corner c) const {
  const int other = face(c.t).next[z(c.i)];
  const Face& f = face(other);
  return {other, f.next[0] == c.t ? 0 : f.next[1] == c.t ? 1 : 2};
}

void Delaunay::join(int t, int i, int other, int piece) {
  Face& f = face(t);
  f.next[z(i)] = other, f.piece[z(i)] = piece;
  if (other < 0) return;
  Face& g = face(other);
  for (int k = 0; k < 3; ++k) {  // found by vertices: for a moment two triangles may name each other twice
    if (g.v[z(after(k))] != f.v[z(before(i))] || g.v[z(before(k))] != f.v[z(after(i))]) continue;
    g.next[z(k)] = t, g.piece[z(k)] = piece;
  }
}

Delaunay::Place Delaunay::locate(const Vec2& x, int from, bool stop_at_pieces) const {
  const Vec2 start = (at(face(from).v[0]) + at(face(from).v[1]) + at(face(from).v[2])) / 3;
  const auto beyond = [&](const Face& f, int i) {
    return orient2d(at(f.v[z(after(i))]), at(f.v[z(before(i))]), x) < 0;
  };
  int t = from, out = -1;
  for (int i = 0; i < 3; ++i) {
    const Face& f = face(t);
    if (beyond(f, i) && (out < 0 || (orient2d(start, x, at(f.v[z(after(i))])) <= 0 &&
                                     orient2d(start, x, at(f.v[z(before(i))])) >= 0)))
      out = i;
  }
  while (out >= 0) {
    if (face(t).next[z(out)] < 0 || (stop_at_pieces && face(t).piece[z(out)] >= 0))
      return {.corner = {t, out}, .blocked = true};
    const Corner in = across({t, out});  // its apex is left or right of the way
    t = in.t;
    out = orient2d(start, x, at(face(t).v[z(in.i)])) > 0 ? after(in.i) : before(in.i);
    if (!beyond(face(t), out)) out = -1;
  }
  Place place{.corner = {t, 0}};
  for (int i = 0; i < 3; ++i) {
    const Face& f = face(t);
    if (at(f.v[z(i)]) == x) place.vertex = f.v[z(i)];
    if (orient2d(at(f.v[z(after(i))]), at(f.v[z(before(i))]), x) == 0)
      place.on_edge = true, place.corner.i = i;
  }
  return place;
}

int Delaunay::add(const Vec2& x, const Place& place) {
  if (place.on_edge) return split_edge(place.corner, x, -1, -1);
  const int v = new_vertex(x), t0 = place.corner.t;
  const Face old = face(t0);
  const int t1 = static_cast<int>(faces_.size()), t2 = t1 + 1;
  faces_.push_back(old), faces_.push_back(old);
  const std::array<int, 3> t = {t0, t1, t2};
  for (std::size_t i = 0; i < 3; ++i)  // t[i] keeps the edge opposite corner i
    face(t[i]).v = {v, old.v[z(after(static_cast<int>(i)))], old.v[z(before(static_cast<int>(i)))]};
  for (std::size_t i = 0; i < 3; ++i) {
    join(t[i], 0, old.next[i], old.piece[i]);
    face(t[i]).next[1] = t[z(after(static_cast<int>(i)))], face(t[i]).piece[1] = -1;
    face(t[i]).next[2] = t[z(before(static_cast<int>(i)))], face(t[i]).piece[2] = -1;
    face_at_[z(face(t[i]).v[1])] = t[i];
    suspects_.push_back({t[i], 0});
  }
  face_at_[z(v)] = t0;
  legalise();
  return v;
}

// Splits the two triangles at an edge in two each. The halves of the edge carry `piece_a` and `piece_b`.
int Delaunay::split_edge(Corner edge, const Vec2& x, int piece_a, int piece_b) {
  const Corner other = across(edge);
  const Face f = face(edge.t), g = face(other.t);
  const int p = f.v[z(edge.i)], a = f.v[z(after(edge.i))], b = f.v[z(before(edge.i))], q = g.v[z(other.i)];
  const int v = new_vertex(x), t2 = static_cast<int>(faces_.size()), t3 = t2 + 1;
  faces_.push_back(f), faces_.push_back(g);
  face(edge.t).v = {v, p, a};  // opposite v: the edge p a
  face(t2).v = {v, b, p};
  face(other.t).v = {v, q, b};
  face(t3).v = {v, a, q};
  join(edge.t, 0, f.next[z(before(edge.i))], f.piece[z(before(edge.i))]);
  join(t2, 0, f.next[z(after(edge.i))], f.piece[z(after(edge.i))]);
  join(other.t, 0, g.next[z(before(other.i))], g.piece[z(before(other.i))]);
  join(t3, 0, g.next[z(after(other.i))], g.piece[z(after(other.i))]);
  const std::array<int, 4> ring = {edge.t, t3, other.t, t2};  // each shares the edge v v[2] with the next
  for (std::size_t i = 0; i < 4; ++i) {
    const int t = ring[i], n = ring[(i + 1) % 4], piece = i == 0 ? piece_a : i == 2 ? piece_b : -1;
    face(t).next[1] = n, face(t).piece[1] = piece;
    face(n).next[2] = t, face(n).piece[2] = piece;
    face_at_[z(face(t).v[1])] = t;
    suspects_.push_back({t, 0});
  }
  face_at_[z(v)] = edge.t;
  legalise();
  return v;
}

// Whether the two triangles at an edge make a strictly convex quadrangle.
bool Delaunay::convex(Corner c) const {
  const Corner o = across(c);
  const Vec2 &p = at(face(c.t).v[z(c.i)]), &q = at(face(o.t).v[z(o.i)]);
  return orient2d(p, q, at(face(c.t).v[z(before(c.i))])) > 0 &&
         orient2d(p, q, at(face(c.t).v[z(after(c.i))])) < 0;
}

// Replaces the triangles p a b and q b a by p a q and q b p.
void Delaunay::flip(Corner c) {
  const Corner o = across(c);
  const Face f = face(c.t), g = face(o.t);
  const int p = f.v[z(c.i)], a = f.v[z(after(c.i))], b = f.v[z(before(c.i))], q = g.v[z(o.i)];
  face(c.t).v = {p, a, q}, face(o.t).v = {q, b, p};
  join(c.t, 0, g.next[z(after(o.i))], g.piece[z(after(o.i))]);    // a q
  join(c.t, 2, f.next[z(before(c.i))], f.piece[z(before(c.i))]);  // p a
  join(o.t, 0, f.next[z(after(c.i))], f.piece[z(after(c.i))]);    // b p
  join(o.t, 2, g.next[z(before(o.i))], g.piece[z(before(o.i))]);  // q b
  face(c.t).next[1] = o.t, face(c.t).piece[1] = -1;
  face(o.t).next[1] = c.t, face(o.t).piece[1] = -1;
  face_at_[z(p)] = face_at_[z(a)] = c.t;
  face_at_[z(q)] = face_at_[z(b)] = o.t;
}

// Flips edges until all those opposite the corners of the suspects are Delaunay; each such corner is the
// newest vertex.
void Delaunay::legalise() {
  while (!suspects_.empty()) {
    const Corner c = suspects_.back();
    suspects_.pop_back();
    const Face& f = face(c.t);
    if (f.next[z(c.i)] < 0 || f.piece[z(c.i)] >= 0) continue;
    const Corner o = across(c);
    if (incircle(at(f.v[0]), at(f.v[1]), at(f.v[2]), at(face(o.t).v[z(o.i)])) <= 0) continue;
    if (!convex(c)) continue;  // only while edges are forced; never where the edges around are Delaunay
    flip(c);
    suspects_.push_back({c.t, 0});  // the corner p
    suspects_.push_back({o.t, 2});
  }
}

Delaunay::Corner Delaunay::find_edge(int a, int b) const {
  Corner found;
  around(a, [&](int t) {
    const Face& f = face(t);
    const int i = index_of(f, a);
    if (f.v[z(after(i))] == b) found = {t, before(i)};
  });
  return found;
}

Delaunay::Corner Delaunay::edge_of(int a, int b) const {
  const Corner found = find_edge(a, b);
  if (found.t < 0) throw std::logic_error("Delaunay: two vertices of a piece are not joined");
  return found;
}

bool Delaunay::force_edge(int a, int b, int piece) {
  std::deque<std::pair<int, int>> crossing;
  std::vector<std::pair<int, int>> changed;
  if (find_edge(a, b).t < 0 && !crossed_edges(a, b, crossing)) return false;
  const auto side = [&](int v) { return orient2d(at(a), at(b), at(v)); };
  while (!crossing.empty()) {
    const auto [l, r] = crossing.front();
    crossing.pop_front();
    const Corner c = edge_of(l, r);
    if (!convex(c)) {
      crossing.emplace_back(l, r);
      continue;
    }
    const int p = face(c.t).v[z(c.i)], q = face(across(c).t).v[z(across(c).i)];
    flip(c);
    if (side(p) * side(q) < 0) {
      crossing.emplace_back(p, q);
    } else {
      changed.emplace_back(p, q);
    }
  }
  const Corner c = edge_of(a, b);
  join(c.t, c.i, face(c.t).next[z(c.i)], piece);
  while (!changed.empty()) {
    const Corner k = find_edge(changed.back().first, changed.back().second);
    changed.pop_back();
    if (k.t < 0 || face(k.t).piece[z(k.i)] >= 0 || face(k.t).next[z(k.i)] < 0) continue;
    const Face f = face(k.t);
    const int p = f.v[z(k.i)], l = f.v[z(after(k.i))], r = f.v[z(before(k.i))];
    const int q = face(across(k).t).v[z(across(k).i)];
    if (incircle(at(p), at(l), at(r), at(q)) <= 0 || !convex(k)) continue;
    flip(k);
    changed.insert(changed.end(), {{p, l}, {l, q}, {q, r}, {r, p}});
  }
  return true;
}

// Lists in order the edges that the straight way from a to b crosses; a and b are not joined. Returns false
// when the way meets another vertex or an edge that carries a piece.
bool Delaunay::crossed_edges(int a, int b, std::deque<std::pair<int, int>>& crossed) const {
  const auto side = [&](int v) { return orient2d(at(a), at(b), at(v)); };
  Corner c;
  around(a, [&](int t) {
    const Face& f = face(t);
    const int i = index_of(f, a), r = f.v[z(after(i))], l = f.v[z(before(i))];
    if (side(r) < 0 && side(l) > 0) c = {t, i};
  });
  if (a == b || c.t < 0) return false;
  while (true) {
    const Face& f = face(c.t);
    if (f.piece[z(c.i)] >= 0) return false;
    crossed.emplace_back(f.v[z(after(c.i))], f.v[z(before(c.i))]);
    const Corner o = across(c);
    const int apex = face(o.t).v[z(o.i)];
    if (apex == b) return true;
    if (side(apex) == 0) return false;
    // In the triangle beyond, after(o.i) is left of the way and before(o.i) is right of it.
    c = {o.t, side(apex) > 0 ? after(o.i) : before(o.i)};
  }
}

bool Delaunay::fits(Corner edge, const Vec2& x) const {
  const Face& f = face(edge.t);
  const Corner other = across(edge);
  const Vec2 &p = at(f.v[z(edge.i)]), &l = at(f.v[z(after(edge.i))]), &r = at(f.v[z(before(edge.i))]),
             &q = at(face(other.t).v[z(other.i)]);
  return orient2d(p, l, x) > 0 && orient2d(l, q, x) > 0 && orient2d(q, r, x) > 0 && orient2d(r, p, x) > 0;
}

int Delaunay::split(Corner edge, const Vec2& x, int a, int piece_a, int piece_b) {
  if (!fits(edge, x)) return -1;
  const bool a_is_after = face(edge.t).v[z(after(edge.i))] == a;
  return a_is_after ? split_edge(edge, x, piece_a, piece_b) : split_edge(edge, x, piece_b, piece_a);
}

void Delaunay::mark_inside(const std::vector<char>& closed) {
  std::vector<char> seen(faces_.size(), 0);
  std::vector<int> stack;
  const auto reach = [&](int t, bool inside) {
    if (t < 0 || seen[z(t)]) return;
    seen[z(t)] = 1;
    face(t).inside = inside;
    stack.push_back(t);
  };
  reach(face_at(0), false);
  while (!stack.empty()) {
    const Face f = face(stack.back());
    stack.pop_back();
    for (std::size_t i = 0; i < 3; ++i)
      reach(f.next[i], f.inside != (f.piece[i] >= 0 && closed[z(f.piece[i])]));
  }
}

}  // namespace drape::internal

// Triangles into a grid of samples with a depth buffer, several samples at a time.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "geometry.h"
#include "texture.h"

namespace mien::render {

constexpr uint32_t kNothing = 0xffffffffu;
constexpr int kTriangleBits = 24;
constexpr int kTile = 8;   // side of the squares of samples whose farthest depth is stored
constexpr int kLanes = 8;  // samples of a row that are tested at once

using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using Mask = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));
using Ids = uint32_t __attribute__((vector_size(kLanes * sizeof(uint32_t))));

constexpr Lanes kOrder = {0, 1, 2, 3, 4, 5, 6, 7};

template <class Vector, class Number>
Vector load_lanes(const Number* from) {
  Vector out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

struct Grid {
  int width = 0, height = 0;
  int stride = 0;            // of rows, so wide that lanes beyond the right edge may be written
  std::vector<float> near;   // 0: empty
  std::vector<uint32_t> id;  // part << 24 | triangle of the part
  int tiles_across = 0;
  std::vector<float> farthest;  // of every tile, as it was when hidden_areas() was called

  void clear(int w, int h) {
    width = w, height = h, stride = w + kLanes;
    near.assign(size_t(stride) * h, 0.0f);
    id.assign(size_t(stride) * h, kNothing);
    farthest.clear();
  }
  size_t at(int x, int y) const { return size_t(y) * size_t(stride) + size_t(x); }

  // Stores the farthest sample of each tile; triangles behind it need not be drawn.
  void hidden_areas() {
    tiles_across = (width + kTile - 1) / kTile;
    const int tiles_down = (height + kTile - 1) / kTile;
    farthest.clear();
    for (int ty = 0; ty < tiles_down; ++ty)
      for (int tx = 0; tx < tiles_across; ++tx)
        farthest.push_back(least_near(tx * kTile, ty * kTile));
  }

 private:
  float least_near(int x0, int y0) const {
    float least = near[at(x0, y0)];
    for (int y = y0; y < std::min(y0 + kTile, height); ++y)
      for (int x = x0; x < std::min(x0 + kTile, width); ++x)
        least = std::min(least, near[at(x, y)]);
    return least;
  }
};

// Weights of a triangle's corners at a point: linear over the grid (for nearness), divide by it for
// perspective.
struct Edges {
  Projected p0, p1, p2;
  float inverse_area;

  Edges(Projected a, Projected b, Projected c) : p0(a), p1(b), p2(c) {
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    inverse_area = area != 0 ? 1 / area : 0;
  }
  Vec3 linear(float x, float y) const {
    const float w1 = ((x - p0.x) * (p2.y - p0.y) - (p2.x - p0.x) * (y - p0.y)) * inverse_area;
    const float w2 = ((p1.x - p0.x) * (y - p0.y) - (x - p0.x) * (p1.y - p0.y)) * inverse_area;
    return {1 - w1 - w2, w1, w2};
  }
  Vec3 step_x() const {
    const float w1 = (p2.y - p0.y) * inverse_area, w2 = (p0.y - p1.y) * inverse_area;
    return {-w1 - w2, w1, w2};
  }
  Vec3 step_y() const {
    const float w1 = (p0.x - p2.x) * inverse_area, w2 = (p1.x - p0.x) * inverse_area;
    return {-w1 - w2, w1, w2};
  }
  float near(Vec3 w) const { return w.x * p0.near + w.y * p1.near + w.z * p2.near; }
  Vec3 perspective(Vec3 w) const {
    const Vec3 q{w.x * p0.near, w.y * p1.near, w.z * p2.near};
    return q * (1 / (q.x + q.y + q.z));
  }
};

// Samples whose centres lie in a triangle's bounding box and on a w x h grid.
struct Bounds {
  int x0, x1, y0, y1;

  Bounds(Projected a, Projected b, Projected c, int w, int h)
      : x0(int(std::max(0.0f, std::ceil(std::min({a.x, b.x, c.x}) - 0.5f)))),
        x1(int(std::min(float(w - 1), std::floor(std::max({a.x, b.x, c.x}) - 0.5f)))),
        y0(int(std::max(0.0f, std::ceil(std::min({a.y, b.y, c.y}) - 0.5f)))),
        y1(int(std::min(float(h - 1), std::floor(std::max({a.y, b.y, c.y}) - 0.5f)))) {}
};

// Whether a triangle is in front of the camera, has an area, faces it (if `cull`) and contains the
// centre of a sample of the grid.
inline bool may_be_seen(Projected a, Projected b, Projected c, float w, float h, bool cull) {
  const float area = (b.x - a.x) * (c.y - a.y) -
                     (c.x - a.x) * (b.y - a.y);  // y points down: front faces turn negative
  const auto least = [](float p, float q, float r) { return std::min(std::min(p, q), r); };
  const auto most = [](float p, float q, float r) { return std::max(std::max(p, q), r); };
  const float x0 = std::max(0.0f, std::ceil(least(a.x, b.x, c.x) - 0.5f));
  const float y0 = std::max(0.0f, std::ceil(least(a.y, b.y, c.y) - 0.5f));
  const float x1 = std::min(w - 1, most(a.x, b.x, c.x) - 0.5f),
              y1 = std::min(h - 1, most(a.y, b.y, c.y) - 0.5f);
  return bool(int(least(a.near, b.near, c.near) > 0) & int(area != 0) & int(!cull | (area < 0)) &
              int(x0 <= x1) & int(y0 <= y1));
}

// Whether every sample of a box is nearer than `nearest`, as far as hidden_areas() noted.
inline bool hidden(const Grid& grid, const Bounds& box, float nearest) {
  if (grid.farthest.empty()) return false;
  for (int ty = box.y0 / kTile; ty <= box.y1 / kTile; ++ty)
    for (int tx = box.x0 / kTile; tx <= box.x1 / kTile; ++tx)
      if (nearest > grid.farthest[size_t(ty) * size_t(grid.tiles_across) + size_t(tx)])
        return false;
  return true;
}

// Calls visit(sample index of the first lane, x, y, nearness, which lanes, linear weights) for runs
// of samples, some covered and nearer than the grid's.
template <class Visit>
void cover(const Edges& e, const Bounds& box, const Grid& grid, Visit visit) {
  const Vec3 origin = e.linear(float(box.x0) + 0.5f, float(box.y0) + 0.5f);
  const Vec3 dx = e.step_x(), dy = e.step_y();
  for (int y = box.y0; y <= box.y1; ++y) {
    const Vec3 row = origin + dy * float(y - box.y0);
    for (int x = box.x0; x <= box.x1; x += kLanes) {
      const Lanes along = kOrder + float(x - box.x0);
      const Lanes w[3] = {row.x + along * dx.x, row.y + along * dx.y, row.z + along * dx.z};
      const Lanes near = w[0] * e.p0.near + w[1] * e.p1.near + w[2] * e.p2.near;
      const size_t at = grid.at(x, y);
      const Lanes before = load_lanes<Lanes>(&grid.near[at]);
      const Mask in = (w[0] >= 0) & (w[1] >= 0) & (w[2] >= 0) & (near > before) &
                      (along <= float(box.x1 - box.x0));
      visit(at, x, y, near, in, w);
    }
  }
}

// Calls draw(triangle of the part, edges, bounds) for triangles that may be seen on a grid. Most
// triangles are not: they are sorted out first, without branches.
template <class Draw>
void each_triangle(const Mesh& mesh, const Part& part, const std::vector<Projected>& screen,
                   const Grid& grid, Draw draw) {
  constexpr int kTogether = 256;
  const int32_t* corners = mesh.corner_position + 3 * part.first;
  const Projected* points = screen.data();
  const float w = float(grid.width), h = float(grid.height);
  for (int begin = 0; begin < part.count; begin += kTogether) {
    const int size = std::min(kTogether, part.count - begin);
    const int32_t* corner = corners + 3 * begin;
    int32_t seen[kTogether];
    for (int t = 0; t < size; ++t)
      seen[t] = may_be_seen(points[corner[3 * t]], points[corner[3 * t + 1]],
                            points[corner[3 * t + 2]], w, h, part.cull != 0);
    for (int t = 0; t < size; ++t) {
      if (!seen[t]) continue;
      const Projected a = points[corner[3 * t]], b = points[corner[3 * t + 1]],
                      c = points[corner[3 * t + 2]];
      const Bounds box(a, b, c, grid.width, grid.height);
      if (!hidden(grid, box, std::max({a.near, b.near, c.near})))
        draw(begin + t, Edges(a, b, c), box);
    }
  }
}

struct Uv {
  float u, v;
};

struct CornerUv {
  Uv a, b, c;
  CornerUv(const Mesh& mesh, const Part& part, int triangle) {
    const int32_t* corner = mesh.corner_uv + 3 * (part.first + triangle);
    a = at(mesh, corner[0]), b = at(mesh, corner[1]), c = at(mesh, corner[2]);
  }
  static Uv at(const Mesh& mesh, int i) { return {mesh.uv[2 * i], mesh.uv[2 * i + 1]}; }
  Uv mix(Vec3 w) const {
    return {w.x * a.u + w.y * b.u + w.z * c.u, w.x * a.v + w.y * b.v + w.z * c.v};
  }
  // Half of the log of how much of the texture's area an image pixel spans, `samples` grid samples
  // to a pixel and axis. With Texture::detail it is the mip level at which a texel is about half a
  // image pixel wide.
  float span(const Edges& e, int samples) const {
    const float area = std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v));
    return 0.5f * fast_log2(area * std::abs(e.inverse_area) * float(samples * samples) + 1e-14f);
  }
};

inline void draw_opaque(const Mesh& mesh, const Part& part, uint32_t number,
                        const std::vector<Projected>& screen, Grid& grid) {
  each_triangle(mesh, part, screen, grid, [&](int t, const Edges& e, const Bounds& box) {
    const uint32_t id = number << kTriangleBits | uint32_t(t);
    cover(e, box, grid, [&](size_t at, int, int, Lanes near, Mask in, const Lanes*) {
      const Lanes nearest = in ? near : load_lanes<Lanes>(&grid.near[at]);
      const Ids ids = in ? Ids{} + id : load_lanes<Ids>(&grid.id[at]);
      std::memcpy(&grid.near[at], &nearest, sizeof nearest);
      std::memcpy(&grid.id[at], &ids, sizeof ids);
    });
  });
}

// The same for nearness alone.
inline void draw_depth(const Mesh& mesh, const Part& part, const std::vector<Projected>& screen,
                       Grid& grid) {
  each_triangle(mesh, part, screen, grid, [&](int, const Edges& e, const Bounds& box) {
    cover(e, box, grid, [&](size_t at, int, int, Lanes near, Mask in, const Lanes*) {
      const Lanes nearest = in ? near : load_lanes<Lanes>(&grid.near[at]);
      std::memcpy(&grid.near[at], &nearest, sizeof nearest);
    });
  });
}

// Calls visit(sample index, x, y, nearness, linear weights) for every covered sample that is nearer
// than the grid's.
template <class Visit>
void each_sample(const Edges& e, const Bounds& box, const Grid& grid, Visit visit) {
  cover(e, box, grid, [&](size_t at, int x, int y, Lanes near, Mask in, const Lanes* w) {
    for (int k = 0; k < kLanes; ++k)
      if (in[k]) visit(at + size_t(k), x + k, y, near[k], Vec3{w[0][k], w[1][k], w[2][k]});
  });
}

// Opacity becomes coverage: each of the 2x2 samples of a pixel has its own threshold.
inline void draw_cutout(const Mesh& mesh, const Part& part, uint32_t number,
                        const std::vector<Projected>& screen, const Texture& texture,
                        bool red_is_alpha, int samples, Grid& grid) {
  static constexpr float kThreshold[2][2] = {{51, 153}, {204, 102}};
  each_triangle(mesh, part, screen, grid, [&](int t, const Edges& e, const Bounds& box) {
    const CornerUv uv(mesh, part, t);
    const float lod = texture.detail() + uv.span(e, samples);
    each_sample(e, box, grid, [&](size_t at, int x, int y, float near, Vec3 w) {
      const Uv p = uv.mix(e.perspective(w));
      const float alpha = texture.nearest(p.u, p.v, lod, red_is_alpha ? 0 : 3);
      if (alpha < kThreshold[y & 1][x & 1]) return;
      grid.near[at] = near;
      grid.id[at] = number << kTriangleBits | uint32_t(t);
    });
  });
}

}  // namespace mien::render

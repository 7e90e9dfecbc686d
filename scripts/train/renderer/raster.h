// Triangles into a grid of samples with a depth buffer.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry.h"
#include "texture.h"

namespace mien::render {

constexpr uint32_t kNothing = 0xffffffffu;
constexpr int kTriangleBits = 24;

struct Grid {
  int width = 0, height = 0;
  std::vector<float> near;   // 0: empty
  std::vector<uint32_t> id;  // part << 24 | triangle of the part

  void clear(int w, int h) {
    width = w, height = h;
    near.assign(size_t(w) * h, 0.0f);
    id.assign(size_t(w) * h, kNothing);
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

// Whether a triangle lies before the camera, has area, faces it (if `cull`) and holds the centre of
// a sample of the grid.
inline bool may_be_seen(Projected a, Projected b, Projected c, float w, float h, bool cull) {
  const float area = (b.x - a.x) * (c.y - a.y) -
                     (c.x - a.x) * (b.y - a.y);  // y points down: front faces turn negative
  const float x0 = std::max(0.0f, std::ceil(std::min({a.x, b.x, c.x}) - 0.5f));
  const float y0 = std::max(0.0f, std::ceil(std::min({a.y, b.y, c.y}) - 0.5f));
  const float x1 = std::min(w - 1, std::max({a.x, b.x, c.x}) - 0.5f),
              y1 = std::min(h - 1, std::max({a.y, b.y, c.y}) - 0.5f);
  return bool(int(std::min({a.near, b.near, c.near}) > 0) & int(area != 0) &
              int(!cull | (area < 0)) & int(x0 <= x1) & int(y0 <= y1));
}

// Calls visit(sample index, x, y, nearness, linear weights) for every covered sample that is nearer
// than the grid's.
template <class Visit>
void cover(const Edges& e, const Bounds& box, Grid& grid, Visit visit) {
  const Vec3 origin = e.linear(float(box.x0) + 0.5f, float(box.y0) + 0.5f);
  const Vec3 dx = e.step_x(), dy = e.step_y();
  for (int y = box.y0; y <= box.y1; ++y) {
    Vec3 w = origin + dy * float(y - box.y0);
    for (int x = box.x0; x <= box.x1; ++x, w = w + dx) {
      if (w.x < 0 || w.y < 0 || w.z < 0) continue;
      const size_t at = size_t(y) * grid.width + x;
      const float near = e.near(w);
      if (near > grid.near[at]) visit(at, x, y, near, w);
    }
  }
}

// Calls draw(triangle of the part, edges, bounds) for triangles that may be seen on a w x h grid.
// Most triangles are not: they are sorted out first, without branches.
template <class Draw>
void each_triangle(const Mesh& mesh, const Part& part, const std::vector<Projected>& screen, int w,
                   int h, Draw draw) {
  constexpr int kBlock = 256;
  const int32_t* corners = mesh.corner_position + 3 * part.first;
  for (int begin = 0; begin < part.count; begin += kBlock) {
    int kept[kBlock], count = 0;
    for (int t = begin; t < std::min(begin + kBlock, part.count); ++t) {
      const int32_t* corner = corners + 3 * t;
      const Projected a = screen[size_t(corner[0])], b = screen[size_t(corner[1])],
                      c = screen[size_t(corner[2])];
      kept[count] = t;
      count += may_be_seen(a, b, c, float(w), float(h), part.cull != 0);
    }
    for (int k = 0; k < count; ++k) {
      const int32_t* corner = corners + 3 * kept[k];
      const Projected a = screen[size_t(corner[0])], b = screen[size_t(corner[1])],
                      c = screen[size_t(corner[2])];
      draw(kept[k], Edges(a, b, c), Bounds(a, b, c, w, h));
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
  // Mip level at which a texel is about half a picture pixel wide, `samples` grid samples to a
  // pixel and axis.
  float lod(const Edges& e, const Texture& texture, int samples) const {
    const float area = std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v));
    const float texels = area * float(texture.width()) * float(texture.height());
    return 0.5f * std::log2(texels * std::abs(e.inverse_area) * float(samples * samples) + 1e-6f) -
           0.3f;
  }
};

inline void draw_opaque(const Mesh& mesh, const Part& part, uint32_t number,
                        const std::vector<Projected>& screen, Grid& grid) {
  each_triangle(mesh, part, screen, grid.width, grid.height,
                [&](int t, const Edges& e, const Bounds& box) {
                  cover(e, box, grid, [&](size_t at, int, int, float near, Vec3) {
                    grid.near[at] = near;
                    grid.id[at] = number << kTriangleBits | uint32_t(t);
                  });
                });
}

// Opacity becomes coverage: each of the 2x2 samples of a pixel has its own threshold.
inline void draw_cutout(const Mesh& mesh, const Part& part, uint32_t number,
                        const std::vector<Projected>& screen, const Texture& texture,
                        bool red_is_alpha, int samples, Grid& grid) {
  static constexpr float kThreshold[2][2] = {{51, 153}, {204, 102}};
  each_triangle(mesh, part, screen, grid.width, grid.height,
                [&](int t, const Edges& e, const Bounds& box) {
                  const CornerUv uv(mesh, part, t);
                  const float lod = uv.lod(e, texture, samples);
                  cover(e, box, grid, [&](size_t at, int x, int y, float near, Vec3 w) {
                    const Uv p = uv.mix(e.perspective(w));
                    const Rgba texel = texture.sample(p.u, p.v, lod);
                    if ((red_is_alpha ? texel.r : texel.a) < kThreshold[y & 1][x & 1]) return;
                    grid.near[at] = near;
                    grid.id[at] = number << kTriangleBits | uint32_t(t);
                  });
                });
}

}  // namespace mien::render

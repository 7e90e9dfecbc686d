// Vertices in camera space, their normals and projections.
#pragma once
#include <cmath>
#include <cstring>
#include <vector>

#include "scene.h"

namespace mien::render {

struct Vec3 {
  float x, y, z;
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 unit(Vec3 a) { return a * (1 / std::sqrt(dot(a, a) + 1e-20f)); }
inline Vec3 load(const float* p) { return {p[0], p[1], p[2]}; }

// Position on a grid of samples, and nearness: larger is closer, linear over the grid.
struct Projected {
  float x, y, near;
};

// All that is interpolated over triangles, side by side, so that a corner is one line of the cache.
struct alignas(64) Attributes {
  Vec3 camera, normal, head;
  float occlusion;
  float unused[6];
};
using AttributeLanes = float __attribute__((vector_size(sizeof(Attributes))));

struct Vertices {
  std::vector<Vec3> camera, normal;  // camera space, cm; normals not yet of unit length
  std::vector<Projected> screen;
  std::vector<Attributes> attributes;
};

// Weighted sum of the attributes of a triangle's corners.
inline Attributes interpolated(const Attributes& a, const Attributes& b, const Attributes& c,
                               Vec3 w) {
  AttributeLanes corner[3];
  std::memcpy(&corner[0], &a, sizeof a), std::memcpy(&corner[1], &b, sizeof b);
  std::memcpy(&corner[2], &c, sizeof c);
  const AttributeLanes sum = corner[0] * w.x + corner[1] * w.y + corner[2] * w.z;
  Attributes out;
  std::memcpy(&out, &sum, sizeof out);
  return out;
}

inline Vec3 transform(const float* pose, Vec3 p) {
  return {pose[0] * p.x + pose[1] * p.y + pose[2] * p.z + pose[3],
          pose[4] * p.x + pose[5] * p.y + pose[6] * p.z + pose[7],
          pose[8] * p.x + pose[9] * p.y + pose[10] * p.z + pose[11]};
}

// Projection of camera space to samples, `samples` of them per image pixel and axis; nearness
// 1/distance, 0 if behind.
inline Projected project(const View& view, int samples, Vec3 p) {
  if (p.z > -1) return {0, 0, 0};
  const float inverse = -1 / p.z, scale = view.scale * float(samples);
  return {(view.centre_x - view.x0 + view.f_px * p.x * inverse) * scale,
          (view.centre_y - view.y0 - view.f_px * p.y * inverse) * scale, inverse};
}

inline void place(const Mesh& mesh, Vertices& out) {
  out.camera.resize(size_t(mesh.vertices));
  for (size_t i = 0; i < out.camera.size(); ++i)
    out.camera[i] = transform(mesh.pose, load(mesh.position + 3 * i));
}

// Gathers the attributes once camera space and normals are known.
inline void gather(const Mesh& mesh, Vertices& v) {
  v.attributes.resize(v.camera.size());
  for (size_t i = 0; i < v.camera.size(); ++i)
    v.attributes[i] = {v.camera[i],
                       v.normal[i],
                       load(mesh.position + 3 * i),
                       mesh.occlusion ? mesh.occlusion[i] : 1.0f,
                       {}};
}

// Adds the area-weighted normals of a part's triangles to its vertices.
inline void add_normals(const Mesh& mesh, const Part& part, Vertices& out) {
  const int32_t* corner = mesh.corner_position + 3 * part.first;
  for (int t = 0; t < part.count; ++t, corner += 3) {
    const Vec3 a = out.camera[size_t(corner[0])];
    const Vec3 n = cross(out.camera[size_t(corner[1])] - a, out.camera[size_t(corner[2])] - a);
    for (int k = 0; k < 3; ++k) {
      Vec3& sum = out.normal[size_t(corner[k])];
      sum = sum + n;
    }
  }
}

}  // namespace mien::render

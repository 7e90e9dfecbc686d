// Shadow map: nearness of the casters seen along the first lamp.
#pragma once
#include "raster.h"

namespace mien::render {

class ShadowMap {
 public:
  static constexpr int kSize = 192;
  static constexpr float kRadius = 22;  // cm around the centre

  // Axes of the map: z towards the lamp.
  void aim(Vec3 to_lamp, Vec3 centre) {
    z_ = to_lamp, centre_ = centre;
    x_ = unit(cross(std::abs(z_.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, z_));
    y_ = cross(z_, x_);
    grid_.clear(kSize, kSize);
  }

  // Where the vertices of a mesh are on the map.
  void project(const Vertices& vertices, std::vector<Projected>& out) const {
    out.resize(vertices.camera.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = project(vertices.camera[i]);
  }

  void draw(const Mesh& mesh, const Part& part, const std::vector<Projected>& on_map) {
    Part both_sides = part;
    both_sides.cull = 0;
    draw_depth(mesh, both_sides, on_map, grid_);
  }

  // Share of light 0..1 that reaches a point, over 2x2 texels.
  float light(Vec3 point, float bias) const {
    const Projected p = project(point);
    const float fx = std::floor(p.x - 0.5f), fy = std::floor(p.y - 0.5f), ax = p.x - 0.5f - fx,
                ay = p.y - 0.5f - fy;
    const int x = int(fx), y = int(fy);
    if (x < 0 || y < 0 || x + 1 >= kSize || y + 1 >= kSize) return 1;
    const float reach = p.near + bias / (4 * kRadius);
    const auto lit = [&](int column, int row) {
      return grid_.near[grid_.at(column, row)] <= reach ? 1.0f : 0.0f;
    };
    return (1 - ay) * ((1 - ax) * lit(x, y) + ax * lit(x + 1, y)) +
           ay * ((1 - ax) * lit(x, y + 1) + ax * lit(x + 1, y + 1));
  }

 private:
  Projected project(Vec3 p) const {
    const Vec3 q = p - centre_;
    const float to_grid = kSize / (2 * kRadius);
    return {(dot(q, x_) + kRadius) * to_grid, (dot(q, y_) + kRadius) * to_grid,
            0.5f + dot(q, z_) / (4 * kRadius)};
  }

  Vec3 x_{}, y_{}, z_{}, centre_{};
  Grid grid_;
};

}  // namespace mien::render

// Renders heads on the CPU: 2x2 samples per pixel find the visible triangles, then pixels are
// shaded.
//
// A pixel whose samples all lie on one surface is shaded once at its centre; at outlines every
// sample is shaded.
#include <array>
#include <cstring>

#include "blend.h"
#include "shade.h"

namespace mien::render {
namespace {

constexpr int kSamples = 2;  // per picture pixel and axis
constexpr float kSameSurfaceCm =
    0.6f;  // samples of one part closer than this in depth count as one surface

class Renderer {
 public:
  Textures textures;

  void geometry(const Scene& scene);
  void start(const Scene& scene) {
    grid_.clear(scene.view.width * kSamples, scene.view.height * kSamples);
  }
  void hide(const Scene& scene, int stage);
  void shadows(const Scene& scene);
  void paint(const Scene& scene, uint8_t* out);
  void visibility(const Scene& scene, const float* points, const float* tolerance, int count,
                  uint8_t* out) const;
  void exposure_to_sky(const Scene& scene, const float* directions, int count, float* out);

 private:
  Surface surface(const Scene& scene, uint32_t id, float x, float y, bool clamp) const;
  Vec3 pixel(const Scene& scene, int x, int y, Vec3 background) const;
  void blend(const Scene& scene, const Part& part);

  std::vector<Vertices> vertices_;
  Grid grid_;
  ShadowMap shadow_;
  std::vector<Projected> scratch_;
  std::vector<Vec3> colour_;  // [height,width] linear
};

void Renderer::geometry(const Scene& scene) {
  vertices_.resize(size_t(scene.mesh_count));
  for (int m = 0; m < scene.mesh_count; ++m) {
    Vertices& v = vertices_[size_t(m)];
    place(scene.meshes[m], v);
    v.normal.assign(v.camera.size(), {0, 0, 0});
    v.screen.resize(v.camera.size());
    for (size_t i = 0; i < v.camera.size(); ++i)
      v.screen[i] = project(scene.view, kSamples, v.camera[i]);
  }
  for (int p = 0; p < scene.part_count; ++p) {
    const Part& part = scene.parts[p];
    add_normals(scene.meshes[part.mesh], part, vertices_[size_t(part.mesh)]);
  }
}

void Renderer::hide(const Scene& scene, int stage) {
  for (int p = 0; p < scene.part_count; ++p) {
    const Part& part = scene.parts[p];
    if (part.stage != stage) continue;
    const Mesh& mesh = scene.meshes[part.mesh];
    const Material& m = scene.materials[part.material];
    const auto& screen = vertices_[size_t(part.mesh)].screen;
    const bool cutout = m.mode == kHair || m.mode == kLash || (m.mode == kEye && m.param[1] > 0);
    if (cutout)
      draw_cutout(mesh, part, uint32_t(p), screen, textures[size_t(m.texture[0])], m.mode == kLash,
                  kSamples, grid_);
    else
      draw_opaque(mesh, part, uint32_t(p), screen, grid_);
  }
}

void Renderer::shadows(const Scene& scene) {
  if (!scene.light.shadow) return;
  shadow_.aim(load(scene.light.direction[0]), load(scene.light.centre));
  for (int p = 0; p < scene.part_count; ++p) {
    const Part& part = scene.parts[p];
    if (part.casts_shadow)
      shadow_.draw(scene.meshes[part.mesh], part, vertices_[size_t(part.mesh)], scratch_);
  }
}

// Attributes of a triangle at sample coordinates; `clamp` keeps a point just outside of it on its
// edge.
Surface Renderer::surface(const Scene& scene, uint32_t id, float x, float y, bool clamp) const {
  const Part& part = scene.parts[id >> kTriangleBits];
  const Mesh& mesh = scene.meshes[part.mesh];
  const int triangle = int(id & ((1u << kTriangleBits) - 1));
  const int32_t* corner = mesh.corner_position + 3 * (part.first + triangle);
  const Vertices& v = vertices_[size_t(part.mesh)];
  const size_t i = size_t(corner[0]), j = size_t(corner[1]), k = size_t(corner[2]);
  const Edges e(v.screen[i], v.screen[j], v.screen[k]);
  Vec3 w = e.linear(x, y);
  if (clamp) {
    w = {std::max(w.x, 0.0f), std::max(w.y, 0.0f), std::max(w.z, 0.0f)};
    w = w * (1 / (w.x + w.y + w.z));
  }
  w = e.perspective(w);
  Surface s{};
  s.material = &scene.materials[part.material];
  s.camera = v.camera[i] * w.x + v.camera[j] * w.y + v.camera[k] * w.z;
  s.head = load(mesh.position + 3 * i) * w.x + load(mesh.position + 3 * j) * w.y +
           load(mesh.position + 3 * k) * w.z;
  s.normal = unit(v.normal[i] * w.x + v.normal[j] * w.y + v.normal[k] * w.z);
  if (dot(s.normal, s.camera) > 0) s.normal = s.normal * -1.0f;
  s.occlusion = mesh.occlusion
                    ? mesh.occlusion[i] * w.x + mesh.occlusion[j] * w.y + mesh.occlusion[k] * w.z
                    : 1.0f;
  const CornerUv uv(mesh, part, triangle);
  s.uv = uv.mix(w);
  for (int t = 0; t < 2; ++t)
    if (s.material->texture[t] >= 0)
      s.lod[t] = uv.lod(e, textures[size_t(s.material->texture[t])], kSamples);
  for (int t = 0; t < kOverlays; ++t) {
    const Overlay& o = s.material->overlay[t];
    if (o.texture < 0) continue;
    const float rect = (o.rect[2] - o.rect[0]) * (o.rect[3] - o.rect[1]);
    s.overlay_lod[t] = uv.lod(e, textures[size_t(o.texture)], kSamples) - 0.5f * std::log2(rect);
  }
  return s;
}

Vec3 Renderer::pixel(const Scene& scene, int x, int y, Vec3 background) const {
  const ShadowMap* shadow = scene.light.shadow ? &shadow_ : nullptr;
  const size_t first = size_t(y) * kSamples * grid_.width + size_t(x) * kSamples;
  const std::array<size_t, 4> at{first, first + 1, first + size_t(grid_.width),
                                 first + size_t(grid_.width) + 1};
  const uint32_t id = grid_.id[at[0]];
  bool same = true;
  for (size_t k : at) {
    const float limit =
        kSameSurfaceCm * grid_.near[first] * grid_.near[first];  // nearness is 1/depth
    same = same && (grid_.id[k] >> kTriangleBits) == (id >> kTriangleBits) &&
           std::abs(grid_.near[k] - grid_.near[first]) <= limit;
  }
  if (same && id == kNothing) return background;
  if (same)
    return shade(surface(scene, id, float(2 * x + 1), float(2 * y + 1), true), textures,
                 scene.light, shadow);
  Vec3 sum{0, 0, 0};
  for (int k = 0; k < 4; ++k) {
    const uint32_t sample = grid_.id[at[size_t(k)]];
    const float sx = float(2 * x + (k & 1)) + 0.5f, sy = float(2 * y + (k >> 1)) + 0.5f;
    sum = sum + (sample == kNothing
                     ? background
                     : shade(surface(scene, sample, sx, sy, false), textures, scene.light, shadow));
  }
  return sum * 0.25f;
}

// A lens tints what is behind it and mirrors the lamps.
void Renderer::blend(const Scene& scene, const Part& part) {
  const Mesh& mesh = scene.meshes[part.mesh];
  const uint32_t number = uint32_t(&part - scene.parts);
  const auto& screen = vertices_[size_t(part.mesh)].screen;
  each_triangle(
      mesh, part, screen, grid_.width, grid_.height, [&](int t, const Edges& e, const Bounds& box) {
        cover(e, box, grid_, [&](size_t, int x, int y, float, Vec3) {
          Vec3& colour =
              colour_[size_t(y / kSamples) * size_t(scene.view.width) + size_t(x / kSamples)];
          const uint32_t id = number << kTriangleBits | uint32_t(t);
          const Surface s = surface(scene, id, float(x) + 0.5f, float(y) + 0.5f, false);
          const Vec3 lens = shade(s, textures, scene.light, nullptr);
          const float share = 1.0f / (kSamples * kSamples);
          const Vec3 gleam =
              lens - times(load(s.material->colour), from_environment(scene.light, s.normal)) *
                         scene.light.exposure;
          colour = mix(colour, lens, s.material->param[0] * share) +
                   gleam * (share * (1 - s.material->param[0]));
        });
      });
}

float to_linear(uint8_t c) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t;
    for (int i = 0; i < 256; ++i) t[size_t(i)] = std::pow(float(i) / 255, 2.2f);
    return t;
  }();
  return table[c];
}

// sRGB byte with a shoulder above 0.6, so that bright skin keeps its shape.
uint8_t to_byte(float c, bool shoulder) {
  static const std::array<uint8_t, 4097> table = [] {
    std::array<uint8_t, 4097> t;
    for (int i = 0; i <= 4096; ++i)
      t[size_t(i)] = uint8_t(255 * std::pow(float(i) / 4096, 1 / 2.2f) + 0.5f);
    return t;
  }();
  if (shoulder && c > 0.6f) c = 0.6f + 0.4f * (1 - std::exp(-(c - 0.6f) / 0.4f));
  return table[size_t(std::clamp(c, 0.0f, 1.0f) * 4096)];
}

void Renderer::paint(const Scene& scene, uint8_t* out) {
  const int w = scene.view.width, h = scene.view.height;
  colour_.resize(size_t(w) * h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const uint8_t* b = scene.background + (size_t(y) * w + x) * 3;
      colour_[size_t(y) * w + x] =
          pixel(scene, x, y, {to_linear(b[0]), to_linear(b[1]), to_linear(b[2])});
    }
  for (int p = 0; p < scene.part_count; ++p)
    if (scene.parts[p].stage == kBlended) blend(scene, scene.parts[p]);
  for (size_t i = 0; i < colour_.size(); ++i) {
    const size_t x = i % size_t(w), y = i / size_t(w);
    const bool drawn = grid_.id[y * kSamples * size_t(grid_.width) + x * kSamples] != kNothing;
    const Vec3 c = colour_[i];
    for (int k = 0; k < 3; ++k)
      out[3 * i + size_t(k)] = to_byte(k == 0 ? c.x : k == 1 ? c.y : c.z, drawn);
  }
}

// A point [3] in camera space is seen unless everything drawn within one sample of it is nearer by
// more than its tolerance.
void Renderer::visibility(const Scene& scene, const float* points, const float* tolerance,
                          int count, uint8_t* out) const {
  for (int i = 0; i < count; ++i) {
    const Projected p = project(scene.view, kSamples, load(points + 3 * i));
    const float limit = 1 / (1 / p.near - tolerance[i]);
    const int cx = int(std::floor(p.x)), cy = int(std::floor(p.y));
    bool seen = false;
    for (int y = cy - 1; y <= cy + 1; ++y)
      for (int x = cx - 1; x <= cx + 1; ++x) {
        const int gx = std::clamp(x, 0, grid_.width - 1), gy = std::clamp(y, 0, grid_.height - 1);
        seen = seen || grid_.near[size_t(gy) * grid_.width + gx] <= limit;
      }
    out[i] = seen;
  }
}

// Share of the directions [count,3] above each vertex of the first mesh that meet nothing, cosine
// weighted.
void Renderer::exposure_to_sky(const Scene& scene, const float* directions, int count, float* out) {
  geometry(scene);
  const Vertices& v = vertices_[0];
  std::vector<float> open(v.camera.size()), all(v.camera.size());
  for (int d = 0; d < count; ++d) {
    const Vec3 to_sky = load(directions + 3 * d);
    shadow_.aim(to_sky, load(scene.light.centre));
    for (int p = 0; p < scene.part_count; ++p)
      shadow_.draw(scene.meshes[scene.parts[p].mesh], scene.parts[p],
                   vertices_[size_t(scene.parts[p].mesh)], scratch_);
    for (size_t i = 0; i < open.size(); ++i) {
      const Vec3 n = unit(v.normal[i]);
      const float cosine = std::max(0.0f, dot(n, to_sky));
      all[i] += cosine;
      if (cosine > 0) open[i] += cosine * shadow_.light(v.camera[i] + n * 0.2f, 0.15f);
    }
  }
  for (size_t i = 0; i < open.size(); ++i) out[i] = all[i] > 0 ? open[i] / all[i] : 1;
}

}  // namespace
}  // namespace mien::render

using mien::render::Renderer;
using mien::render::Scene;

extern "C" {

Renderer* renderer_create() { return new Renderer; }

void renderer_destroy(Renderer* renderer) { delete renderer; }

// Number of the new texture; rgba [height,width,4].
int renderer_add_texture(Renderer* renderer, const uint8_t* rgba, int width, int height, int wrap) {
  renderer->textures.emplace_back(rgba, width, height, wrap != 0);
  return int(renderer->textures.size()) - 1;
}

// Picture out [height,width,3] sRGB; visible [count] of points [count,3] (camera space, cm) with
// tolerance [count] (cm).
void renderer_render(Renderer* renderer, const Scene* scene, uint8_t* out, const float* points,
                     const float* tolerance, int count, uint8_t* visible) {
  renderer->geometry(*scene);
  renderer->shadows(*scene);
  renderer->start(*scene);
  renderer->hide(*scene, mien::render::kOpaque);
  renderer->visibility(*scene, points, tolerance, count, visible);
  renderer->hide(*scene, mien::render::kFringe);
  renderer->paint(*scene, out);
}

void renderer_blend_shapes(const float* weights, const float* basis, int rows, int shapes, int n,
                           float* out) {
  mien::render::blend_shapes(weights, basis, rows, shapes, size_t(n), out);
}

// How open to the sky each vertex of the first mesh is, out [vertices]; directions [count,3], unit.
void renderer_occlusion(Renderer* renderer, const Scene* scene, const float* directions, int count,
                        float* out) {
  renderer->exposure_to_sky(*scene, directions, count, out);
}

}  // extern "C"

// Renders heads on the CPU: 2x2 samples per pixel find the visible triangles, then pixels are
// shaded.
//
// A pixel whose samples all lie on one surface is shaded once at its centre; at outlines every
// sample is shaded.
#include <array>
#include <cstring>

#include "blend.h"
#include "folding.h"
#include "shade.h"

namespace mien::render {
namespace {

constexpr int kSamples = 2;  // per image pixel and axis
// Samples of one part closer than this in depth count as one surface.
constexpr float kSameSurfaceCm = 0.6f;

class Renderer {
 public:
  Textures textures;

  void geometry(const Scene& scene);
  void start(const Scene& scene) {
    grid_.clear(scene.view.width * kSamples, scene.view.height * kSamples);
  }
  void rasterize(const Scene& scene, int stage);
  void shadows(const Scene& scene);
  void paint(const Scene& scene, uint8_t* out);
  void visibility(const Scene& scene, const float* points, const float* tolerance, int count,
                  uint8_t* out) const;
  void exposure_to_sky(const Scene& scene, const float* directions, int count, float* out);

 private:
  // A visible point of a triangle, which contributes to a pixel.
  struct Fragment {
    uint32_t id;
    float x, y;   // sample coordinates
    bool clamp;   // moves a point just outside the triangle to its edge
    float share;  // of its pixel
    size_t pixel;
  };

  Surface surface(const Scene& scene, const Fragment& fragment) const;
  void add_fragment(const Scene& scene, const Fragment& fragment);
  void prefetch_corners(const Scene& scene, uint32_t id) const;
  bool one_surface(size_t first) const;
  void add_pixel(const Scene& scene, int x, int y, Vec3 background);
  void add_outline(const Scene& scene, int x, int y, Vec3 background);
  void fill_batch(const Scene& scene, const ShadowMap* shadow);
  void shade_fragments(const Scene& scene);
  void blend(const Scene& scene, const Part& part);
  void blend_fragments(const Scene& scene, const Material& lens);

  std::vector<Vertices> vertices_;
  Grid grid_;
  ShadowMap shadow_;
  std::vector<Projected> scratch_;
  std::vector<Vec3> colour_;  // [height,width] linear
  std::vector<Fragment> fragments_;
  Batch batch_;
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
  for (int m = 0; m < scene.mesh_count; ++m) gather(scene.meshes[m], vertices_[size_t(m)]);
}

void Renderer::rasterize(const Scene& scene, int stage) {
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
    // The face comes first and hides most of the rest.
    if (p == 0) grid_.hidden_areas();
  }
}

void Renderer::shadows(const Scene& scene) {
  if (!scene.light.shadow) return;
  shadow_.aim(load(scene.light.direction[0]), load(scene.light.centre));
  for (int m = 0; m < scene.mesh_count; ++m) {
    shadow_.project(vertices_[size_t(m)], scratch_);
    for (int p = 0; p < scene.part_count; ++p)
      if (scene.parts[p].mesh == m && scene.parts[p].casts_shadow)
        shadow_.draw(scene.meshes[m], scene.parts[p], scratch_);
  }
}

// Lists a fragment, and prefetches its triangle.
void Renderer::add_fragment(const Scene& scene, const Fragment& fragment) {
  const Part& part = scene.parts[fragment.id >> kTriangleBits];
  const Mesh& mesh = scene.meshes[part.mesh];
  const int triangle = part.first + int(fragment.id & ((1u << kTriangleBits) - 1));
  __builtin_prefetch(mesh.corner_position + 3 * triangle);
  __builtin_prefetch(mesh.corner_uv + 3 * triangle);
  fragments_.push_back(fragment);
}

// Prefetches the corners of a triangle.
void Renderer::prefetch_corners(const Scene& scene, uint32_t id) const {
  const Part& part = scene.parts[id >> kTriangleBits];
  const Mesh& mesh = scene.meshes[part.mesh];
  const int triangle = part.first + int(id & ((1u << kTriangleBits) - 1));
  const Vertices& v = vertices_[size_t(part.mesh)];
  for (int k = 0; k < 3; ++k) {
    const size_t corner = size_t(mesh.corner_position[3 * triangle + k]);
    __builtin_prefetch(&v.attributes[corner]);
    __builtin_prefetch(&v.screen[corner]);
    __builtin_prefetch(mesh.uv + 2 * mesh.corner_uv[3 * triangle + k]);
  }
}

// The surface at a fragment.
Surface Renderer::surface(const Scene& scene, const Fragment& fragment) const {
  const Part& part = scene.parts[fragment.id >> kTriangleBits];
  const Mesh& mesh = scene.meshes[part.mesh];
  const int triangle = int(fragment.id & ((1u << kTriangleBits) - 1));
  const int32_t* corner = mesh.corner_position + 3 * (part.first + triangle);
  const Vertices& v = vertices_[size_t(part.mesh)];
  const size_t i = size_t(corner[0]), j = size_t(corner[1]), k = size_t(corner[2]);
  const Edges e(v.screen[i], v.screen[j], v.screen[k]);
  Vec3 w = e.linear(fragment.x, fragment.y);
  if (fragment.clamp) {
    w = {std::max(w.x, 0.0f), std::max(w.y, 0.0f), std::max(w.z, 0.0f)};
    w = w * (1 / (w.x + w.y + w.z));
  }
  w = e.perspective(w);
  const Attributes here = interpolated(v.attributes[i], v.attributes[j], v.attributes[k], w);
  Surface s;
  s.material = &scene.materials[part.material];
  s.camera = here.camera, s.head = here.head, s.occlusion = here.occlusion;
  s.normal = unit(here.normal);
  if (dot(s.normal, s.camera) > 0) s.normal = s.normal * -1.0f;
  const CornerUv uv(mesh, part, triangle);
  s.uv = uv.mix(w);
  s.span = uv.span(e, kSamples);
  return s;
}

// Whether the samples of a pixel, including `first`, lie on one surface or on none.
bool Renderer::one_surface(size_t first) const {
  const size_t below = first + size_t(grid_.stride);
  const uint32_t part = grid_.id[first] >> kTriangleBits;
  const float near = grid_.near[first];
  const float limit = kSameSurfaceCm * near * near;  // nearness is 1/depth
  bool same = true;
  for (size_t k : {first + 1, below, below + 1})
    same &= (grid_.id[k] >> kTriangleBits) == part && std::abs(grid_.near[k] - near) <= limit;
  return same;
}

// Lists the fragments of a pixel, and adds the visible background to the image.
void Renderer::add_pixel(const Scene& scene, int x, int y, Vec3 background) {
  const size_t first = grid_.at(kSamples * x, kSamples * y);
  const size_t to = size_t(y) * size_t(scene.view.width) + size_t(x);
  const uint32_t id = grid_.id[first];
  const bool same = one_surface(first);
  colour_[to] = same && id == kNothing ? background : Vec3{0, 0, 0};
  if (!same)
    add_outline(scene, x, y, background);
  else if (id != kNothing)
    add_fragment(scene, {id, float(2 * x + 1), float(2 * y + 1), true, 1, to});
}

// The same of a pixel in which several surfaces meet; each becomes one fragment.
void Renderer::add_outline(const Scene& scene, int x, int y, Vec3 background) {
  const size_t to = size_t(y) * size_t(scene.view.width) + size_t(x), begin = fragments_.size();
  float nearness[kSamples * kSamples];
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const int sx = kSamples * x + (k & 1), sy = kSamples * y + (k >> 1);
    const uint32_t id = grid_.id[grid_.at(sx, sy)];
    const float near = grid_.near[grid_.at(sx, sy)], limit = kSameSurfaceCm * near * near;
    if (id == kNothing) {
      colour_[to] = colour_[to] + background * 0.25f;
      continue;
    }
    size_t same = begin;
    while (same < fragments_.size() &&
           (fragments_[same].id >> kTriangleBits != id >> kTriangleBits ||
            std::abs(nearness[same - begin] - near) > limit))
      ++same;
    nearness[same - begin] = near;
    if (same < fragments_.size())
      fragments_[same].share += 0.25f;
    else
      add_fragment(scene, {id, float(sx) + 0.5f, float(sy) + 0.5f, false, 0.25f, to});
  }
}

// Moves all fragments to the batch.
void Renderer::fill_batch(const Scene& scene, const ShadowMap* shadow) {
  constexpr size_t kAhead = 8;
  batch_.count = 0;
  for (size_t k = 0; k < fragments_.size(); ++k) {
    if (k + kAhead < fragments_.size()) prefetch_corners(scene, fragments_[k + kAhead].id);
    const Fragment& fragment = fragments_[k];
    batch_.add(surface(scene, fragment), textures, shadow, fragment.pixel, fragment.share);
  }
  fragments_.clear();
}

void Renderer::shade_fragments(const Scene& scene) {
  fill_batch(scene, scene.light.shadow ? &shadow_ : nullptr);
  shade(scene.light, batch_);
  for (int i = 0; i < batch_.count; ++i) {
    Vec3& pixel = colour_[batch_.pixel[i]];
    pixel = pixel + batch_.answer(i) * batch_.share[i];
  }
}

// A lens tints the surface behind it and mirrors the lamps.
void Renderer::blend(const Scene& scene, const Part& part) {
  const Mesh& mesh = scene.meshes[part.mesh];
  const uint32_t number = uint32_t(&part - scene.parts);
  const auto& screen = vertices_[size_t(part.mesh)].screen;
  const Material& lens = scene.materials[part.material];
  each_triangle(mesh, part, screen, grid_, [&](int t, const Edges& e, const Bounds& box) {
    each_sample(e, box, grid_, [&](size_t, int x, int y, float, Vec3) {
      const size_t to = size_t(y / kSamples) * size_t(scene.view.width) + size_t(x / kSamples);
      add_fragment(scene, {number << kTriangleBits | uint32_t(t), float(x) + 0.5f, float(y) + 0.5f,
                           false, 1.0f / (kSamples * kSamples), to});
      if (fragments_.size() == Batch::kSize) blend_fragments(scene, lens);
    });
  });
  blend_fragments(scene, lens);
}

void Renderer::blend_fragments(const Scene& scene, const Material& lens) {
  fill_batch(scene, nullptr);
  shade(scene.light, batch_);
  for (int i = 0; i < batch_.count; ++i) {
    Vec3& pixel = colour_[batch_.pixel[i]];
    const Vec3 c = batch_.answer(i);
    const Vec3 matt = times(load(lens.colour), from_environment(scene.light, batch_.normal(i)));
    const Vec3 gleam = c - matt * scene.light.exposure;
    pixel = mix(pixel, c, lens.param[0] * batch_.share[i]) +
            gleam * (batch_.share[i] * (1 - lens.param[0]));
  }
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
      add_pixel(scene, x, y, {to_linear(b[0]), to_linear(b[1]), to_linear(b[2])});
      if (fragments_.size() > Batch::kSize - kSamples * kSamples) shade_fragments(scene);
    }
  shade_fragments(scene);
  for (int p = 0; p < scene.part_count; ++p)
    if (scene.parts[p].stage == kBlended) blend(scene, scene.parts[p]);
  for (size_t i = 0; i < colour_.size(); ++i) {
    const size_t x = i % size_t(w), y = i / size_t(w);
    const bool drawn = grid_.id[grid_.at(int(x) * kSamples, int(y) * kSamples)] != kNothing;
    const Vec3 c = colour_[i];
    for (int k = 0; k < 3; ++k)
      out[3 * i + size_t(k)] = to_byte(k == 0 ? c.x : k == 1 ? c.y : c.z, drawn);
  }
}

// A point [3] in camera space is visible unless everything drawn within one sample of it is nearer
// by more than its tolerance.
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
        seen = seen || grid_.near[grid_.at(gx, gy)] <= limit;
      }
    out[i] = seen;
  }
}

// Cosine-weighted share of the directions [count,3] above each vertex of the first mesh that hit
// nothing.
void Renderer::exposure_to_sky(const Scene& scene, const float* directions, int count, float* out) {
  geometry(scene);
  const Vertices& v = vertices_[0];
  std::vector<float> open(v.camera.size()), all(v.camera.size());
  for (int d = 0; d < count; ++d) {
    const Vec3 to_sky = load(directions + 3 * d);
    shadow_.aim(to_sky, load(scene.light.centre));
    shadow_.project(v, scratch_);
    for (int p = 0; p < scene.part_count; ++p)
      shadow_.draw(scene.meshes[0], scene.parts[p], scratch_);
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

// Image out [height,width,3] sRGB; visible [count] of points [count,3] (camera space, cm) with
// tolerance [count] (cm).
void renderer_render(Renderer* renderer, const Scene* scene, uint8_t* out, const float* points,
                     const float* tolerance, int count, uint8_t* visible) {
  renderer->geometry(*scene);
  renderer->shadows(*scene);
  renderer->start(*scene);
  renderer->rasterize(*scene, mien::render::kOpaque);
  renderer->visibility(*scene, points, tolerance, count, visible);
  renderer->rasterize(*scene, mien::render::kFringe);
  renderer->paint(*scene, out);
}

void renderer_blend_shapes(const float* weights, const float* basis, int rows, int shapes,
                           int blocks, float* out) {
  mien::render::blend_shapes(weights, basis, rows, shapes, blocks, out);
}

// Subtracts the shade of the folds of a posed head [vertices,3] from openness [vertices].
void renderer_darken(const mien::render::Folds* folds, const float* posed, float* open) {
  thread_local mien::render::Folding folding;
  folding.darken(*folds, posed, open);
}

// How open to the sky each vertex of the first mesh is, out [vertices]; directions [count,3], unit.
void renderer_occlusion(Renderer* renderer, const Scene* scene, const float* directions, int count,
                        float* out) {
  renderer->exposure_to_sky(*scene, directions, count, out);
}

}  // extern "C"

// Compression of the skin around every vertex, and the shade of the resulting folds.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

namespace mien::render {

// The skin of a person at rest, shared with ctypes (native.py mirrors it field by field). Pointers
// are borrowed for the duration of a call.
struct Folds {
  const int32_t* first;   // [edges] vertices of the head
  const int32_t* second;  // [edges]
  const int32_t* at;      // [edges] the same as indices into the skin
  const int32_t* to;      // [edges]
  const float* square;    // [edges] squared length at rest
  const float* along;     // [edges,2] share of it along y and x
  const float* scale;     // [skin,2] 1 / sum of the shares around a vertex
  const int32_t* start;   // [skin+1] start of each vertex's neighbours, which include itself
  const int32_t* neighbour;
  const float* shade;     // [skin,2] darkness of a deep fold along y and x
  const int32_t* vertex;  // [skin] index in the head
  int32_t edges, skin;
  float begins, deepest;  // compression at which folds begin, and are deepest
};

struct Pair {
  float y, x;
};

class Folding {
 public:
  // Darkens `open` [vertices] where `posed` [vertices,3] is compressed.
  void darken(const Folds& f, const float* posed, float* open) {
    lose(f, posed);
    average(f, lost_, smooth_), average(f, smooth_, lost_);
    for (int i = 0; i < f.skin; ++i) {
      const Pair p = lost_[size_t(i)];
      const float across = depth(f, p.y) * f.shade[2 * i],
                  along = depth(f, p.x) * f.shade[2 * i + 1];
      open[f.vertex[i]] -= across > along ? across : along;
    }
  }

 private:
  void lose(const Folds& f, const float* posed) {
    lost_.assign(size_t(f.skin), {0, 0});
    for (int e = 0; e < f.edges; ++e) {
      const float *a = posed + 3 * f.first[e], *b = posed + 3 * f.second[e];
      const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
      const float lost = 1 - std::sqrt((x * x + y * y + z * z) / f.square[e]);
      for (int32_t end : {f.at[e], f.to[e]}) {
        lost_[size_t(end)].y += f.along[2 * e] * lost;
        lost_[size_t(end)].x += f.along[2 * e + 1] * lost;
      }
    }
    for (int i = 0; i < f.skin; ++i)
      lost_[size_t(i)].y *= f.scale[2 * i], lost_[size_t(i)].x *= f.scale[2 * i + 1];
  }

  // Averages over each vertex and its neighbours.
  static void average(const Folds& f, const std::vector<Pair>& in, std::vector<Pair>& out) {
    out.resize(in.size());
    for (int i = 0; i < f.skin; ++i) {
      Pair sum{0, 0};
      for (int k = f.start[i]; k < f.start[i + 1]; ++k) {
        const Pair p = in[size_t(f.neighbour[k])];
        sum.y += p.y, sum.x += p.x;
      }
      const float share = 1.0f / float(f.start[i + 1] - f.start[i]);
      out[size_t(i)] = {sum.y * share, sum.x * share};
    }
  }

  static float depth(const Folds& f, float lost) {
    const float t = (lost - f.begins) / (f.deepest - f.begins);
    return t <= 0 ? 0.0f : 1 - std::exp(-3 * (t < 1 ? t : 1.0f));
  }

  std::vector<Pair> lost_, smooth_;
};

}  // namespace mien::render

// Steps of filters that look at neighbourhoods, make noise or light: each beside what the SVG specification says,
// written again, in each pixel.
#include "layers_fixture.h"

#include <functional>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using Pixel = std::array<double, 4>;

constexpr uint32_t kSize = 64;

struct FiltersTest : LayersTest {
  /// A picture of a few rectangles at whole pixels, and its pixels (premultiplied).
  static const std::vector<std::pair<std::array<int, 4>, std::array<float, 4>>>& boxes() {
    static const std::vector<std::pair<std::array<int, 4>, std::array<float, 4>>> all = {
        {{10, 12, 40, 40}, {0.8f, 0.3f, 0.1f, 1}},
        {{30, 20, 52, 50}, {0.2f, 0.6f, 0.9f, 0.6f}},
        {{16, 30, 24, 56}, {1, 1, 0, 0.5f}}};
    return all;
  }
  static Pixel source(int x, int y) {
    Pixel p{};
    for (const auto& [box, color] : boxes()) {
      if (x < box[0] || y < box[1] || x >= box[2] || y >= box[3]) continue;
      for (size_t k = 0; k < 4; ++k)
        p[k] = double(color[3]) * (k < 3 ? double(color[k]) : 1) + p[k] * (1 - double(color[3]));
    }
    return p;
  }
  void expectPicture(std::vector<GpgpFilterStep> steps, const std::function<Pixel(int, int)>& want, double within) {
    makeLayerCanvas();
    Scene scene;
    GpgpLayer layer = scene.filter(std::move(steps));
    const float region[4] = {0, 0, kSize, kSize};
    std::copy_n(region, 4, layer.filterRegion);
    const uint32_t group = scene.group(0, 1, &layer);
    for (const auto& [b, color] : boxes())
      scene.add(solid(float(b[0]), float(b[1]), float(b[2]), float(b[3]), color), group);
    const auto pixels = draw(scene, kSize);
    for (int y = 0; y < int(kSize); ++y)
      for (int x = 0; x < int(kSize); ++x)
        expectNear(pixels[size_t(y) * kSize + size_t(x)], want(x, y), within,
                   std::to_string(x) + ", " + std::to_string(y));
  }
  static GpgpFilterStep inside(GpgpFilterStep s) {
    const float region[4] = {0, 0, kSize, kSize};
    std::copy_n(region, 4, s.region);
    return s;
  }
};

TEST_F(FiltersTest, MorphologyTakesExtremes) {
  for (const int mode : {0, 1})
    expectPicture(
        {inside(step(GPGP_FILTER_MORPHOLOGY, {3, 2}, mode))},
        [&](int x, int y) {
          Pixel p = source(x, y);
          for (int j = -2; j <= 2; ++j)
            for (int i = -3; i <= 3; ++i)
              for (size_t k = 0; k < 4; ++k)
                p[k] = mode ? std::max(p[k], source(x + i, y + j)[k]) : std::min(p[k], source(x + i, y + j)[k]);
          return p;
        },
        2e-3);
}

TEST_F(FiltersTest, ConvolutionsFollowTheSpecification) {
  const std::vector<float> kernel = {1, 2, 0, -1, 0.5f, 3, 0, 1, -2, 4, 1, 0};
  for (const int edges : {GPGP_EDGE_NONE, GPGP_EDGE_DUPLICATE, GPGP_EDGE_WRAP})
    for (const int variant : {0, 1, 2}) {
      const bool keeps = variant == 1;
      const int dx = variant == 2 ? 2 : 1, dy = variant == 2 ? -3 : 1; // the elements' distances
      GpgpFilterStep s = inside(step(GPGP_FILTER_CONVOLVE_MATRIX, {4, 3, 1, 2, 8, 0.05f, keeps ? 1.f : 0.f}, edges));
      if (variant == 2) s.values[7] = 2, s.values[8] = -3;
      s.table = kernel.data();
      s.tableCount = 12;
      const auto at = [&](int x, int y) {
        const int n = int(kSize);
        if (edges == GPGP_EDGE_DUPLICATE) x = std::clamp(x, 0, n - 1), y = std::clamp(y, 0, n - 1);
        if (edges == GPGP_EDGE_WRAP) x = (x + n) % n, y = (y + n) % n;
        return x < 0 || y < 0 || x >= n || y >= n ? Pixel{} : source(x, y);
      };
      expectPicture(
          {s},
          [&](int x, int y) {
            Pixel sum{};
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 4; ++j) {
                Pixel p = at(x + dx * (j - 1), y + dy * (i - 2));
                if (keeps)
                  for (size_t k = 0; k < 3; ++k) p[k] = p[3] > 0 ? p[k] / p[3] : 0;
                for (size_t k = 0; k < 4; ++k) sum[k] += p[k] * double(kernel[size_t((2 - i) * 4 + 3 - j)]);
              }
            const double bias = 0.05f, alpha = keeps ? source(x, y)[3] : sum[3] / 8 + bias;
            for (size_t k = 0; k < 3; ++k) sum[k] = std::clamp(sum[k] / 8 + bias * (keeps ? 1 : alpha), 0.0, 1.0);
            sum[3] = std::clamp(alpha, 0.0, 1.0);
            if (keeps) return Pixel{sum[0] * alpha, sum[1] * alpha, sum[2] * alpha, alpha};
            for (size_t k = 0; k < 3; ++k) sum[k] = std::min(sum[k], sum[3]);
            return sum;
          },
          4e-3);
    }
}

TEST_F(FiltersTest, DisplacementMovesByItsMap) {
  const GpgpFilterStep map = inside(step(GPGP_FILTER_FLOOD, {0.75f, 0.25f, 0, 1}));
  expectPicture(
      {map, inside(step(GPGP_FILTER_DISPLACEMENT_MAP, {16}, 4, GPGP_FILTER_SOURCE, GPGP_FILTER_FIRST_STEP))},
      [](int x, int y) { return source(x + 4, y - 4); }, 2e-3);
}

TEST_F(FiltersTest, TilesRepeatTheirInput) {
  GpgpFilterStep part = step(GPGP_FILTER_OFFSET);
  const float region[4] = {20, 22, 37, 33};
  std::copy_n(region, 4, part.region);
  expectPicture(
      {part, inside(step(GPGP_FILTER_TILE, {}, 0, GPGP_FILTER_FIRST_STEP))},
      [](int x, int y) {
        const auto in = [](int v, int low, int size) { return low + ((v - low) % size + size) % size; };
        return source(in(x, 20, 17), in(y, 22, 11));
      },
      2e-3);
}

// Whose borders cross pixels: a flood that is repeated is a flood.
TEST_F(FiltersTest, TilesHaveNoSeams) {
  GpgpFilterStep part = step(GPGP_FILTER_FLOOD, {0.5f, 0.25f, 0.125f, 0.75f});
  const float region[4] = {20.3f, 22.6f, 31.45f, 33.2f};
  std::copy_n(region, 4, part.region);
  expectPicture(
      {part, inside(step(GPGP_FILTER_TILE, {}, 0, GPGP_FILTER_FIRST_STEP))},
      [](int, int) {
        return Pixel{0.5 * 0.75, 0.25 * 0.75, 0.125 * 0.75, 0.75};
      },
      2e-3);
}

TEST_F(FiltersTest, GroupsShowInFilters) {
  makeLayerCanvas();
  Scene scene;
  GpgpFilterStep shown = step(GPGP_FILTER_GROUP, {2, 0, 0, 2, 4, 8});
  shown.group = 2;
  const GpgpLayer layer = scene.filter({shown});
  const uint32_t group = scene.group(0, 1, &layer), other = scene.group();
  scene.add(solid(0, 0, 8, 8), group);
  scene.add(solid(4, 4, 12, 16, {1, 0, 0, 1}), other);
  const auto pixels = draw(scene, kSize);
  for (int y = 0; y < int(kSize); ++y)
    for (int x = 0; x < int(kSize); ++x) {
      const bool in = x >= 12 && x < 28 && y >= 16 && y < 40;
      expectNear(pixels[size_t(y) * kSize + size_t(x)], in ? Pixel{1, 0, 0, 1} : Pixel{}, 1e-3, std::to_string(x));
    }
}

// ---------------------------------------------------------------- noise

/// The program of the SVG specification (feTurbulence), in double precision.
class Noise {
public:
  explicit Noise(long seed) {
    if (seed <= 0) seed = -(seed % 2147483646) + 1;
    if (seed > 2147483646) seed = 2147483646;
    const auto random = [&seed] {
      long result = 16807 * (seed % 127773) - 2836 * (seed / 127773);
      if (result <= 0) result += 2147483647;
      return seed = result;
    };
    int i, j, k;
    for (k = 0; k < 4; ++k)
      for (i = 0; i < 256; ++i) {
        lattice_[i] = i;
        for (j = 0; j < 2; ++j) gradient_[k][i][j] = double(random() % 512 - 256) / 256;
        const double s = std::sqrt(gradient_[k][i][0] * gradient_[k][i][0] + gradient_[k][i][1] * gradient_[k][i][1]);
        gradient_[k][i][0] /= s, gradient_[k][i][1] /= s;
      }
    while (--i) {
      k = lattice_[i];
      lattice_[i] = lattice_[j = int(random() % 256)];
      lattice_[j] = k;
    }
    for (i = 0; i < 258; ++i) {
      lattice_[256 + i] = lattice_[i];
      for (k = 0; k < 4; ++k)
        for (j = 0; j < 2; ++j) gradient_[k][256 + i][j] = gradient_[k][i][j];
    }
  }
  /// tile: width and height of what is stitched at (0, 0); 0: nothing is.
  double at(int channel, double x, double y, double fx, double fy, int octaves, bool fractal, double tile) const {
    int width = 0, height = 0, wrapX = 0, wrapY = 0;
    if (tile > 0) {
      for (double* f : {&fx, &fy}) {
        const double low = std::floor(tile * *f) / tile, high = std::ceil(tile * *f) / tile;
        *f = *f / low < high / *f ? low : high;
      }
      width = int(tile * fx + 0.5), height = int(tile * fy + 0.5);
      wrapX = 4096 + width, wrapY = 4096 + height;
    }
    double sum = 0, ratio = 1, v[2] = {x * fx, y * fy};
    for (int octave = 0; octave < octaves; ++octave) {
      const double n = noise(channel, v, tile > 0, width, height, wrapX, wrapY);
      sum += (fractal ? n : std::abs(n)) / ratio;
      v[0] *= 2, v[1] *= 2, ratio *= 2;
      width *= 2, height *= 2, wrapX = 2 * wrapX - 4096, wrapY = 2 * wrapY - 4096;
    }
    return std::clamp(fractal ? (sum + 1) / 2 : sum, 0.0, 1.0);
  }

private:
  double noise(int channel, const double* v, bool stitch, int width, int height, int wrapX, int wrapY) const {
    double t = v[0] + 4096;
    int bx0 = int(t), bx1 = bx0 + 1;
    const double rx0 = t - int(t), rx1 = rx0 - 1;
    t = v[1] + 4096;
    int by0 = int(t), by1 = by0 + 1;
    const double ry0 = t - int(t), ry1 = ry0 - 1;
    if (stitch) {
      if (bx0 >= wrapX) bx0 -= width;
      if (bx1 >= wrapX) bx1 -= width;
      if (by0 >= wrapY) by0 -= height;
      if (by1 >= wrapY) by1 -= height;
    }
    bx0 &= 255, bx1 &= 255, by0 &= 255, by1 &= 255;
    const int i = lattice_[bx0], j = lattice_[bx1];
    const int b00 = lattice_[i + by0], b10 = lattice_[j + by0], b01 = lattice_[i + by1], b11 = lattice_[j + by1];
    const auto curve = [](double s) { return s * s * (3 - 2 * s); };
    const auto lerp = [](double s, double a, double b) { return a + s * (b - a); };
    const auto dot = [&](int b, double x, double y) {
      return x * gradient_[channel][b][0] + y * gradient_[channel][b][1];
    };
    const double sx = curve(rx0), sy = curve(ry0);
    return lerp(sy, lerp(sx, dot(b00, rx0, ry0), dot(b10, rx1, ry0)), lerp(sx, dot(b01, rx0, ry1), dot(b11, rx1, ry1)));
  }
  int lattice_[514];
  double gradient_[4][514][2];
};

TEST_F(FiltersTest, NoiseIsTheSpecificationsProgram) {
  struct Case {
    float fx, fy;
    int octaves;
    float seed;
    bool fractal, stitched;
  };
  for (const Case& c : {Case{0.05f, 0.08f, 1, 0, true, false}, Case{0.11f, 0.07f, 4, 17, true, false},
                        Case{0.06f, 0.06f, 3, -5, false, false}, Case{0.07f, 0.05f, 2, 3, false, true}}) {
    const Noise noise(static_cast<long>(c.seed));
    expectPicture(
        {inside(step(GPGP_FILTER_TURBULENCE, {c.fx, c.fy, float(c.octaves), c.seed, c.stitched ? 1.f : 0.f},
                     c.fractal ? 0 : 1))},
        [&](int x, int y) {
          Pixel p{};
          for (int k = 0; k < 4; ++k)
            p[size_t(k)] = noise.at(k, x, y, double(c.fx), double(c.fy), c.octaves, c.fractal, c.stitched ? kSize : 0);
          for (size_t k = 0; k < 3; ++k) p[k] *= p[3];
          return p;
        },
        4e-3);
  }
}

// ---------------------------------------------------------------- light

using Vector = std::array<double, 3>;
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector normal(Vector v) {
  const double length = std::sqrt(dot(v, v));
  for (double& c : v) c /= length;
  return v;
}

TEST_F(FiltersTest, LightFollowsTheSpecification) {
  const double scale = 3;
  const int last = int(kSize) - 1;
  const auto height = [](int x, int y) { return source(x, y)[3]; };
  /// The specification's table of nine cases.
  int apart = 1; // heights that are compared
  const auto surface = [&](int x, int y) {
    const auto i = [&](int dx, int dy) { return height(x + apart * dx, y + apart * dy); };
    const int l = x >= apart ? -1 : 0, r = x <= last - apart ? 1 : 0, t = y >= apart ? -1 : 0,
              b = y <= last - apart ? 1 : 0;
    double nx = 0, ny = 0, rows = 0, columns = 0;
    for (int k = -1; k <= 1; ++k) {
      const double weight = k == 0 ? 2 : 1;
      if ((k < 0 && t == 0) || (k > 0 && b == 0)) continue;
      nx += weight * (i(r, k) - i(l, k)), rows += weight;
    }
    for (int k = -1; k <= 1; ++k) {
      const double weight = k == 0 ? 2 : 1;
      if ((k < 0 && l == 0) || (k > 0 && r == 0)) continue;
      ny += weight * (i(k, b) - i(k, t)), columns += weight;
    }
    const auto factor = [](double weights, int span) { return span == 2 ? 1 / weights : 2 / weights; };
    return normal({-scale * factor(rows, r - l) * nx, -scale * factor(columns, b - t) * ny, 1});
  };
  const Vector color = {1, 0.8, 0.5};
  for (const bool specular : {false, true})
    for (const int kind : {GPGP_LIGHT_DISTANT, GPGP_LIGHT_POINT, GPGP_LIGHT_SPOT}) {
      apart = kind == GPGP_LIGHT_POINT ? 2 : 1;
      std::vector<float> values = {float(scale), 1.2f, 1, 0.8f, 0.5f};
      if (specular) values.push_back(6);
      const std::vector<float> light = kind == GPGP_LIGHT_DISTANT ? std::vector<float>{0.7f, 0.9f}
                                                                  : std::vector<float>{20, 14, 30, 40, 40, 0, 3, 0.6f};
      values.insert(values.end(), light.begin(), light.end());
      const auto l = [&](size_t k) { return double(light[k]); };
      values.resize(16);
      values[14] = values[15] = apart == 1 ? 0 : static_cast<float>(apart);
      expectPicture(
          {inside(step(specular ? GPGP_FILTER_SPECULAR_LIGHTING : GPGP_FILTER_DIFFUSE_LIGHTING, values, kind))},
          [&](int x, int y) {
            Vector toLight{};
            double brightness = 1;
            if (kind == GPGP_LIGHT_DISTANT) {
              toLight = {std::cos(l(0)) * std::cos(l(1)), std::sin(l(0)) * std::cos(l(1)), std::sin(l(1))};
            } else {
              toLight = normal({l(0) - (x + 0.5), l(1) - (y + 0.5), l(2) - scale * apart * height(x, y)});
              const double along = -dot(toLight, normal({l(3) - l(0), l(4) - l(1), l(5) - l(2)}));
              if (kind == GPGP_LIGHT_SPOT) brightness = along <= 0 || along < l(7) ? 0 : std::pow(along, l(6));
            }
            const Vector n = surface(x, y), half = normal({toLight[0], toLight[1], toLight[2] + 1});
            const double lit = specular ? std::pow(std::max(dot(n, half), 0.0), 6) : std::max(dot(n, toLight), 0.0);
            Pixel p{};
            for (size_t k = 0; k < 3; ++k) p[k] = std::clamp(1.2 * lit * brightness * color[k], 0.0, 1.0);
            p[3] = specular ? std::max({p[0], p[1], p[2]}) : 1;
            return p;
          },
          // Heights are half floats.
          0.012);
    }
}

} // namespace

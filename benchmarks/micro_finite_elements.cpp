// The march of underfoot_block.explicit in C++: gather, element loop, scatter, cosine
// floor, move. The element loop is filled with the statements that the Numba kernel is made of.
#include <cmath>
#include <cstring>
#include <vector>

typedef REAL T;
static const int L = LANES;

static void element(T *__restrict W, const T *__restrict E, T *__restrict Q, const T *P, int terms) {
  (void)terms;
// statements
}

extern "C" void march(long count, long chunks, long stride, long plane, long layers, double *u,
                      double *v, double *f, const long *offsets, const T *E, T *Q, long rows,
                      const T *P, int terms, const double *x, const double *y, const double *z,
                      const double *stiffness, const double *inverse, const double *floor,
                      double dt, double speed, double slid) {
  std::vector<T> W(WORK * L);
  const double amplitude = floor[0], k = 2.0 * M_PI * floor[1];
  const long free_nodes = plane * (layers - 1);
  for (long step = 0; step < count; ++step) {
    std::memset(f, 0, 3 * stride * sizeof(double));
    for (long c = 0; c < chunks; ++c) {
      for (int r = 0; r < 24; ++r) {
        const double *s = u + (r / 8) * stride + c * L + offsets[r % 8];
        for (int l = 0; l < L; ++l) W[r * L + l] = s[l];
      }
      element(W.data(), E + c * ELEMENT_ROWS * L, Q + c * rows * L, P, terms);
      for (int r = 0; r < 24; ++r) {
        double *s = f + (r / 8) * stride + c * L + offsets[r % 8];
        for (int l = 0; l < L; ++l) s[l] += W[r * L + l];
      }
    }
    for (long n = 0; n < plane; ++n) {
      const double zn = z[n] + u[2 * stride + n];
      if (zn > amplitude) continue;
      const double px = k * (x[n] + u[n] + slid), py = k * (y[n] + u[stride + n]);
      const double cx = std::cos(px), cy = std::cos(py);
      const double gap = zn - amplitude * cx * cy;
      if (gap >= 0.0) continue;
      const double push = -stiffness[n] * gap;
      f[n] -= push * amplitude * k * std::sin(px) * cy;
      f[stride + n] -= push * amplitude * k * cx * std::sin(py);
      f[2 * stride + n] -= push;
    }
    for (int axis = 0; axis < 3; ++axis) {
      double *ua = u + axis * stride, *va = v + axis * stride;
      const double *fa = f + axis * stride;
      for (long n = 0; n < free_nodes; ++n) {
        va[n] -= dt * fa[n] * inverse[n];
        ua[n] += dt * va[n];
      }
    }
    slid += dt * speed;
  }
}

/* Shared volume of 1024 pairs of random tetrahedra by r3d (Powell & Abel 2015), the pairs of
   crates/ndda-contact/benches/cases/mod.rs. Prints nanoseconds per pair and the sum of the volumes [JSON]. */
#include "r3d.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

enum { PAIRS = 1024, ROUNDS = 50 };

static uint64_t seed = 1;

static double next(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) / 9007199254740992.0;
}

static double six_volumes(const r3d_rvec3 *t) {
  double e[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      e[i][k] = t[i + 1].xyz[k] - t[0].xyz[k];
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

static void random_tet(r3d_rvec3 *t) {
  for (;;) {
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k)
        t[i].xyz[k] = next();
    double volume = six_volumes(t) / 6.0;
    if (volume < 0.0) {
      r3d_rvec3 first = t[0];
      t[0] = t[1];
      t[1] = first;
    }
    if (fabs(volume) > 0.02)
      return;
  }
}

static double shared_volume(r3d_rvec3 *a, r3d_rvec3 *b) {
  r3d_poly polyhedron;
  r3d_plane faces[4];
  r3d_real volume[1] = {0.0};
  r3d_tet_faces_from_verts(faces, b);
  r3d_init_tet(&polyhedron, a);
  r3d_clip(&polyhedron, faces, 4);
  r3d_reduce(&polyhedron, volume, 0);
  return volume[0];
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(void) {
  static r3d_rvec3 pair[PAIRS][2][4];
  for (int n = 0; n < PAIRS;) {
    random_tet(pair[n][0]);
    random_tet(pair[n][1]);
    n += shared_volume(pair[n][0], pair[n][1]) > 1e-4;
  }
  double best = INFINITY, sum = 0.0;
  for (int round = 0; round < ROUNDS; ++round) {
    double start = now();
    sum = 0.0;
    for (int n = 0; n < PAIRS; ++n)
      sum += shared_volume(pair[n][0], pair[n][1]);
    best = fmin(best, (now() - start) / PAIRS);
  }
  printf("{\"ns_per_pair\": %.1f, \"volume\": %.12g}\n", 1e9 * best, sum);
  return 0;
}

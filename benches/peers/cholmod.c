/* Solves by CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008), supernodal, ordered by AMD and by METIS, of matrices that
   the bench `solve` of ndda-solver has written; and the rate at which memory of a given size can be read.
   Arguments: file and bytes, for each matrix. Prints for each ordering microseconds per solve and per solve of eight at
   once, milliseconds of the factorisation and bytes of the factor; then GB/s. */
#include <cholmod.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void *must(void *memory) {
  if (!memory) {
    fprintf(stderr, "out of memory\n");
    exit(1);
  }
  return memory;
}

static void read_all(void *to, size_t size, FILE *file) {
  if (fread(to, 1, size, file) != size) {
    fprintf(stderr, "a matrix is cut short\n");
    exit(1);
  }
}

static cholmod_sparse *read_matrix(const char *path, cholmod_common *common) {
  FILE *file = must(fopen(path, "rb"));
  int64_t size[2];
  read_all(size, sizeof size, file);
  cholmod_sparse *a = must(cholmod_l_allocate_sparse(size[0], size[0], size[1], 1, 1, -1, CHOLMOD_REAL, common));
  read_all(a->p, 8 * (size[0] + 1), file);
  read_all(a->i, 8 * size[1], file);
  read_all(a->x, 8 * size[1], file);
  fclose(file);
  return a;
}

/* Least time of a solve of so many columns [s], over about 0.3 s. */
static double solve(cholmod_factor *l, size_t columns, cholmod_common *common) {
  cholmod_dense *b = must(cholmod_l_zeros(l->n, columns, CHOLMOD_REAL, common));
  for (size_t i = 0; i < l->n * columns; ++i)
    ((double *)b->x)[i] = (double)(i % 17) - 8.0;
  cholmod_dense *x = NULL, *y = NULL, *e = NULL;
  double least = 1e9, begin = now();
  while (now() - begin < 0.3) {
    double start = now();
    if (!cholmod_l_solve2(CHOLMOD_A, l, b, NULL, &x, NULL, &y, &e, common))
      exit(1);
    double time = now() - start;
    least = time < least ? time : least;
  }
  cholmod_l_free_dense(&x, common), cholmod_l_free_dense(&y, common), cholmod_l_free_dense(&e, common);
  cholmod_l_free_dense(&b, common);
  return least;
}

static void ordered(int ordering, cholmod_sparse *a, cholmod_common *common) {
  common->nmethods = 1;
  common->method[0].ordering = ordering;
  common->supernodal = CHOLMOD_SUPERNODAL;
  common->final_ll = 1;
  double start = now();
  cholmod_factor *l = must(cholmod_l_analyze(a, common));
  if (!cholmod_l_factorize(a, l, common) || !l->is_super)
    exit(1);
  double factored = now() - start;
  printf("%.3f %.3f %.1f %zu ", 1e6 * solve(l, 1, common), 1e6 / 8 * solve(l, 8, common), 1e3 * factored, 8 * l->xsize);
  cholmod_l_free_factor(&l, common);
}

/* Rate of reading so many bytes again and again, the best of about 0.3 s [GB/s]. */
static double read_rate(size_t bytes) {
  size_t n = bytes / 512 * 64;
  double *data = must(aligned_alloc(64, 8 * n + 64)), sums[64] = {0}, best = 0.0, begin = now();
  for (size_t i = 0; i < n; ++i)
    data[i] = 1.0;
  while (now() - begin < 0.3) {
    double start = now();
    for (size_t i = 0; i < n; i += 64)
      for (size_t k = 0; k < 64; ++k)
        sums[k] += data[i + k];
    double rate = 8e-9 * n / (now() - start);
    best = rate > best ? rate : best;
  }
  volatile double keep = 0.0;
  for (size_t k = 0; k < 64; ++k)
    keep += sums[k];
  free(data);
  return best;
}

int main(int count, char **argument) {
  cholmod_common common;
  cholmod_l_start(&common);
  for (int k = 1; k + 1 < count; k += 2) {
    cholmod_sparse *a = read_matrix(argument[k], &common);
    ordered(CHOLMOD_AMD, a, &common);
    ordered(CHOLMOD_METIS, a, &common);
    printf("%.2f\n", read_rate(strtoull(argument[k + 1], NULL, 10)));
    cholmod_l_free_sparse(&a, &common);
  }
  cholmod_l_finish(&common);
  return 0;
}

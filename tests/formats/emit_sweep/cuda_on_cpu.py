"""CUDA on the processor: the text as C++, its kernels called for one thread after the other."""

from __future__ import annotations

import ctypes
import itertools
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BLOCKS = 3
THREADS = 5
KINDS = {"float64": np.float64, "float32": np.float32}

SHIM = r"""
#include <math.h>
#include <string.h>
#define __global__
#define __device__
struct dim { unsigned int x, y, z; };
static dim gridDim = {BLOCKS, 1, 1}, blockDim = {THREADS, 1, 1}, blockIdx, threadIdx;
template <class T> static T atomicAdd(T *p, T x) { const T old = *p; *p = old + x; return old; }
template <class T> static T atomicMin(T *p, T x) { const T old = *p; *p = x < old ? x : old; return old; }
/* every fourth time as if another thread had just written a number a little smaller */
template <class T> static T atomicCAS(T *p, T seen, T x) {
    static int call;
    const T old = *p;
    if (++call % 4 == 1) { return old - 1; }
    if (old == seen) { *p = x; }
    return old;
}
template <class T, class F> static T bits(F x) { T y; memcpy(&y, &x, sizeof y); return y; }
static double __longlong_as_double(long long x) { return bits<double>(x); }
static long long __double_as_longlong(double x) { return bits<long long>(x); }
static float __uint_as_float(unsigned int x) { return bits<float>(x); }
static unsigned int __float_as_uint(float x) { return bits<unsigned int>(x); }
"""
SET = """
extern "C" void set_thread(unsigned int block, unsigned int thread) { blockIdx.x = block; threadIdx.x = thread; }
"""
CUDA = """
#define __global__ __attribute__((global))
#define __device__ __attribute__((device))
struct dim { unsigned int x, y, z; };
extern const __device__ dim gridDim, blockDim, blockIdx, threadIdx;
__device__ float fabs(float);
__device__ double fabs(double);
__device__ float floor(float);
__device__ double floor(double);
__device__ float sqrt(float);
__device__ double sqrt(double);
__device__ double sin(double);
__device__ double cos(double);
__device__ double copysign(double, double);
__device__ float atan2f(float, float);
__device__ void sincosf(float, float *, float *);
__device__ unsigned long long atomicAdd(unsigned long long *, unsigned long long);
__device__ unsigned long long atomicMin(unsigned long long *, unsigned long long);
__device__ unsigned long long atomicCAS(unsigned long long *, unsigned long long, unsigned long long);
__device__ unsigned int atomicCAS(unsigned int *, unsigned int, unsigned int);
__device__ double __longlong_as_double(long long);
__device__ long long __double_as_longlong(double);
__device__ float __uint_as_float(unsigned int);
__device__ unsigned int __float_as_uint(float);
"""
"""The little of CUDA's headers that the text needs, with CUDA's types."""
WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Wdouble-promotion", "-Werror", "-Wno-unused-function")


def check_as_cuda(folder: Path, text: str) -> None:
    """Clang's front end for CUDA takes it for the host, and for the device, where all that a kernel calls
    has to be the device's.
    """
    clang = shutil.which("clang++") or shutil.which("clang")
    if clang is None:
        pytest.skip("no clang: nothing took the text as CUDA")
    (folder / "arm.cu").write_text(CUDA + text, encoding="ascii")
    for side in ("--cuda-host-only", "--cuda-device-only"):
        words = [clang, "-x", "cuda", side, "-nocudainc", "-nocudalib", "--cuda-gpu-arch=sm_70"]
        words += ["-std=c++11", "-fsyntax-only", *WARNINGS, "-Wno-unknown-cuda-version", "arm.cu"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr


class Device:
    """Kernels of a text that run one thread after the other, the last one first."""

    def __init__(self, folder: Path, text: str, precision: str = "float64") -> None:
        compiler = shutil.which("g++") or shutil.which("clang++")
        if compiler is None:
            pytest.skip("no C++ compiler: what is emitted was not run")
        shim = SHIM.replace("BLOCKS", str(BLOCKS)).replace("THREADS", str(THREADS))
        (folder / "arm.cpp").write_text(shim + text + SET, encoding="ascii")
        words = [compiler, "-std=c++11", "-O2", "-ffp-contract=off", *WARNINGS]
        words += ["-fPIC", "-shared", "arm.cpp", "-o", "arm.so", "-lm"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr
        self._library = ctypes.CDLL(str(folder / "arm.so"))
        self.kind = KINDS[precision]

    def launch(self, kernel: str, *arguments: Any) -> None:
        """Run a kernel: integers, and arrays of 64-bit integers or of the text's real numbers."""
        for array in arguments:
            assert isinstance(array, int) or array.dtype in (np.int64, np.uint64, self.kind)
        given = [
            ctypes.c_longlong(x) if isinstance(x, int) else x.ctypes.data_as(ctypes.c_void_p)
            for x in arguments
        ]
        threads = list(itertools.product(range(BLOCKS), range(THREADS)))
        for block, thread in reversed(threads):
            self._library.set_thread(block, thread)
            self._library[kernel](*given)

    def poses(self, kernel: str, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of configurations (N, m)."""
        T = np.empty((len(q), 4, 4), self.kind)
        self.launch(kernel, len(q), np.ascontiguousarray(q, self.kind), T)
        return T

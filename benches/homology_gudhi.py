"""CPU seconds of GUDHI's Z/2 persistence on the complexes that benches/homology.rs wrote.

python benches/homology_gudhi.py DIR    (needs gudhi and numpy)

Only compute_persistence is timed, the least of three; building the simplex tree is told apart.
"""

import pathlib
import sys
import time

import gudhi
import numpy

print(f"gudhi {gudhi.__version__}")
print(f"{'complex':<24} {'Betti Z/2':<10} {'insertion':>10} {'persistence':>12}")
for path in sorted(pathlib.Path(sys.argv[1]).glob("*.npz")):
    triangles = numpy.ascontiguousarray(numpy.load(path)["triangles"].T.astype(numpy.int32))
    tree = gudhi.SimplexTree()
    start = time.process_time()
    tree.insert_batch(triangles, numpy.zeros(triangles.shape[1]))
    tree.initialize_filtration()
    insertion = time.process_time() - start
    least = float("inf")
    for _ in range(3):
        start = time.process_time()
        tree.compute_persistence(homology_coeff_field=2, persistence_dim_max=True)
        least = min(least, time.process_time() - start)
    betti = ",".join(map(str, tree.betti_numbers()))
    print(f"{path.stem:<24} {betti:<10} {insertion:>10.2f} {least:>12.2f}", flush=True)

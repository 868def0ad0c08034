# CGAL 5.5: exact geometric predicates and triangulations. Header-only; the target brings GMP, MPFR and -frounding-math, which interval
# arithmetic needs: link it PRIVATE, to small libraries with plain structs at their border.
find_package(CGAL 5.5 REQUIRED CONFIG)

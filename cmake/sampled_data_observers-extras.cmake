# One rounding per operation, as in this package: otherwise laws and plants that are compiled
# elsewhere may give other bits on other machines.
add_compile_options(-ffp-contract=off)

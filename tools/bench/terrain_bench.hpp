#pragma once

namespace wex {

/// Times every terrain layer on a 400 x 400 map of 0.1 m cells, and the queries; prints medians and
/// percentiles to stdout. Returns an exit code.
int bench_terrain();

}  // namespace wex

# Copied by tools/fetch_deps to PREFIX/lib/cmake/Ipopt.
get_filename_component(_wex_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET Ipopt::Ipopt)
  function(_wex_import name file)
    add_library(Ipopt::${name} SHARED IMPORTED)
    set_target_properties(Ipopt::${name} PROPERTIES
      IMPORTED_LOCATION "${_wex_prefix}/lib/${file}" IMPORTED_SONAME "${file}")
  endfunction()
  _wex_import(Ipopt libipopt.so.3)
  _wex_import(mumps libcoinmumps.so.3)
  _wex_import(metis libcoinmetis.so.2)
  _wex_import(blas libcasadi-tp-openblas.so.0)
  _wex_import(gfortran libgfortran-8f1e9814.so.5.0.0)
  _wex_import(quadmath libquadmath-828275a7.so.0.0.0)
  # The link-dependent ones only close libipopt's undefined symbols; the program does not name them.
  set_target_properties(Ipopt::Ipopt PROPERTIES
    IMPORTED_LINK_DEPENDENT_LIBRARIES
      "Ipopt::mumps;Ipopt::metis;Ipopt::blas;Ipopt::gfortran;Ipopt::quadmath"
    INTERFACE_INCLUDE_DIRECTORIES "${_wex_prefix}/include/coin-or")
endif()
unset(_wex_prefix)

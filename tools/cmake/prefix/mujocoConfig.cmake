# Copied by tools/fetch_deps to PREFIX/lib/cmake/mujoco.
get_filename_component(_wex_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET mujoco::mujoco)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES
    IMPORTED_LOCATION "${_wex_prefix}/lib/libmujoco.so.3.17.0"
    IMPORTED_SONAME libmujoco.so.3.17.0
    INTERFACE_INCLUDE_DIRECTORIES "${_wex_prefix}/include")
endif()
unset(_wex_prefix)

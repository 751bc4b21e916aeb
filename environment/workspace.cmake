# Included by every project of the workspace. `FROM_WHEELS` is on where ROS 2 itself comes as Python wheels.

if(FROM_WHEELS)
  # The wheels have no C++ nodes: what only those need, a third of the work, would serve nobody.
  find_package(rosidl_default_generators QUIET)
  list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "_cpp:")

  # The wheels' CMake files name include folders of the machine that built the wheels, which CMake refuses because they
  # do not exist here. They are not needed: drop them, once all packages of a project have been found. The files
  # themselves stay as they are; they may be shared with other environments.
  function(_drop_wheel_includes)
    get_directory_property(targets DIRECTORY "${CMAKE_SOURCE_DIR}" IMPORTED_TARGETS)
    foreach(target IN LISTS targets)
      get_target_property(includes ${target} INTERFACE_INCLUDE_DIRECTORIES)
      if(includes MATCHES "/opt/python/")
        list(FILTER includes EXCLUDE REGEX "^/opt/python/")
        set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${includes}")
      endif()
    endforeach()
  endfunction()
  cmake_language(DEFER DIRECTORY "${CMAKE_SOURCE_DIR}" CALL _drop_wheel_includes)
endif()

# What makes messages known to DDS is a file a message, each of which reads the same headers for a second: compiled as
# one, they take a third of the time. Others of the generated files define the same names, so that they cannot be one.
function(_compile_as_one)
  get_directory_property(targets DIRECTORY "${CMAKE_SOURCE_DIR}" BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    if(target MATCHES "__rosidl_typesupport_(cpp|fastrtps_c|fastrtps_cpp)$")
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    endif()
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY "${CMAKE_SOURCE_DIR}" CALL _compile_as_one)

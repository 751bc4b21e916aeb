# Included by every project of the workspace. `FROM_WHEELS` is on where ROS 2 itself comes as Python wheels.

# Typesupports that are compiled as one: each message's file reads the same headers for half a second, so that one file
# of all takes a third of the time. Others of the generated files define the same names and cannot be one.
set(_whole cpp fastrtps_c fastrtps_cpp)

if(FROM_WHEELS)
  # The wheels have no C++ nodes, and one DDS, which needs no introspection: half of the code would serve nobody.
  find_package(rosidl_default_generators QUIET)
  list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "introspection|_cpp:")
  set(STATIC_ROSIDL_TYPESUPPORT_C rosidl_typesupport_fastrtps_c)
  list(APPEND _whole c)  # as it then chooses between no others

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

function(_compile_as_one)
  get_directory_property(targets DIRECTORY "${CMAKE_SOURCE_DIR}" BUILDSYSTEM_TARGETS)
  foreach(kind IN LISTS _whole)
    foreach(target IN LISTS targets)
      if(target MATCHES "__rosidl_typesupport_${kind}$")
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
      endif()
    endforeach()
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY "${CMAKE_SOURCE_DIR}" CALL _compile_as_one)

# Included by tests/mutation/base.py: disables unity builds of mutated sources.
cmake_language(DEFER CALL set_target_properties mien_animation PROPERTIES UNITY_BUILD OFF)

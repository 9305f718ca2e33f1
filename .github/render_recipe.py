"""Renders the recipe for conda-forge for several platforms, as its feedstock would."""

from __future__ import annotations

import tempfile
from pathlib import Path

from rattler_build import PlatformConfig, RenderConfig, Stage0Recipe, VariantConfig

RECIPE = Path(__file__).parents[1] / "recipe" / "recipe.yaml"
# The compilers that conda-forge pins, by platform.
C_LIBRARIES = {
    "linux-64": "sysroot",
    "linux-aarch64": "sysroot",
    "osx-64": "macosx_deployment_target",
    "osx-arm64": "macosx_deployment_target",
    "win-64": "vs",
}


def render(platform: str, c_library: str) -> str:
    """What the recipe asks for on one platform."""
    with tempfile.TemporaryDirectory() as folder:
        variants = Path(folder) / "variants.yaml"
        variants.write_text(f"c_compiler: [cc]\nrust_compiler: [rust]\nc_stdlib: [{c_library}]\n")
        target = PlatformConfig(target_platform=platform, host_platform=platform)
        chosen = VariantConfig.from_file(str(variants))
        rendered = Stage0Recipe.from_file(str(RECIPE)).render(chosen, RenderConfig(platform=target))
    recipes = [variant.recipe for variant in rendered]
    return "; ".join(
        f"{recipe.package.name} {recipe.package.version}: "
        f"runs with {', '.join(str(need) for need in recipe.requirements.run)}"
        for recipe in recipes
    )


if __name__ == "__main__":
    for platform, c_library in C_LIBRARIES.items():
        print(f"{platform}: {render(platform, c_library)}")

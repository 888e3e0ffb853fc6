"""Plug-ins: entry points of installed packages, loaded only where the settings name them."""

from importlib.metadata import EntryPoint, entry_points
from typing import Any

from tracker.errors import NavigationError

IMAGE_SOURCES = "coaxial.image_sources"
SINKS = "coaxial.sinks"
SOURCE_PREFIX = "plugin:"


class PluginError(NavigationError):
    """A plug-in is not installed, or cannot be loaded."""


def plugin_names(group: str) -> list[str]:
    """Return the names of the installed plug-ins of a group. Imports none of them."""
    return sorted({one.name for one in entry_points(group=group)})


def load_plugin(group: str, name: str) -> Any:  # noqa: ANN401  whatever the entry point refers to
    """Import a plug-in and return what its entry point refers to.

    Raises:
        PluginError: PLUGIN_NOT_INSTALLED, PLUGIN_AMBIGUOUS, PLUGIN_NOT_LOADED.
    """
    found = list(entry_points(group=group, name=name))
    if not found:
        names = ", ".join(plugin_names(group)) or "none"
        raise PluginError(
            "PLUGIN_NOT_INSTALLED",
            f"there is no plug-in {name} in {group}; installed: {names}",
            "Install its package into the environment of Coaxial, or correct its name in the settings.",
            {"plugin": name, "group": group, "installed": names},
        )
    if len(found) > 1:
        packages = ", ".join(sorted(map(_package, found)))
        raise PluginError(
            "PLUGIN_AMBIGUOUS",
            f"{len(found)} packages have a plug-in {name} in {group}: {packages}",
            "Uninstall all of them but one.",
            {"plugin": name, "group": group, "count": len(found), "packages": packages},
        )
    try:
        return found[0].load()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise PluginError(
            "PLUGIN_NOT_LOADED",
            f"the plug-in {name} cannot be imported: {reason}",
            "Correct or update its package, then start again.",
            {"plugin": name, "library_error": reason},
        ) from error


def _package(entry: EntryPoint) -> str:
    return "an unknown package" if entry.dist is None else entry.dist.name

"""Makes a release: version, changelog, build, checksums, signature, commit and tag.

    release.py --version 1.2.0 --key ~/.ssh/id_ed25519 [--dry-run]
    release.py [--key KEY]

Without a version, the release of the tag at HEAD is built again, so that anybody can compare its checksums.

The signature is one of OpenSSH: each Debian has ssh-keygen, it verifies without a network, a service or a
stored state, the keys are those that people have already (also on hardware), and git signs the tag with it.
GPG needs a key ring for that, minisign has to be installed, and sigstore needs a service.
"""

import argparse
import difflib
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from packaging.version import Version

ROOT = Path(__file__).resolve().parents[1]
CHANGELOG, PROJECT = ROOT / "CHANGELOG.md", ROOT / "pyproject.toml"
SAMPLES = "tests/procedure/samples"
ALLOWED_SIGNERS = ROOT / "docs" / "allowed_signers"
# The name in `docs/allowed_signers`, and what a signature is for, which the guide states.
PRINCIPAL, NAMESPACE = "coaxial", "coaxial-release"
SUMS = "SHA256SUMS"
NUMBER = r"(?:0|[1-9]\d*)"
# Those versions of SemVer that Python's packages can have, too.
SEMVER = re.compile(rf"{NUMBER}\.{NUMBER}\.{NUMBER}(?:-(?:alpha|beta|rc)\.{NUMBER})?")
UNRELEASED = "## [Unreleased]\n"
DATED = re.compile(r"^## \[(.+)\] - (\d{4}-\d\d-\d\d)$", re.MULTILINE)
VERSION_LINE = re.compile(r'^version = "(.+)"$', re.MULTILINE)


def run(*command: str | Path, shown: bool = False) -> str:
    """Run a command in the checkout and return its output; the program ends with a sentence if it fails."""
    words = [str(word) for word in command]
    if shown:
        print("$", shlex.join(words), flush=True)
    done = subprocess.run(words, cwd=ROOT, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"`{shlex.join(words)}` failed: {(done.stderr or done.stdout).strip()}")
    return done.stdout.rstrip()


def sign(file: Path, key: Path) -> None:
    """Sign a file, and verify the signature as a hospital does."""
    run("ssh-keygen", "-Y", "sign", "-q", "-f", key, "-n", NAMESPACE, file)
    command = ["ssh-keygen", "-Y", "verify", "-f", str(ALLOWED_SIGNERS), "-I", PRINCIPAL, "-n", NAMESPACE]
    text = file.read_text(encoding="utf-8")
    done = subprocess.run(
        [*command, "-s", f"{file}.sig"], input=text, check=False, capture_output=True, text=True
    )
    if done.returncode != 0:
        sys.exit(
            f"The key {key} is not in docs/allowed_signers, so that nobody could verify the release: "
            f"commit a line with '{PRINCIPAL}' and its public key."
        )


def reject_unsigned(key: Path | None) -> Path:
    """Return the key, if a hospital can verify what it signs."""
    if key is None:
        sys.exit("No key to sign with: give the releaser's own SSH key, KEY=~/.ssh/id_ed25519.")
    if not key.is_file():
        sys.exit(f"There is no key {key}: give the releaser's own SSH key, KEY=~/.ssh/id_ed25519.")
    if shutil.which("ssh-keygen") is None:
        sys.exit("ssh-keygen was not found: install openssh-client.")
    with tempfile.TemporaryDirectory() as folder:
        probe = Path(folder) / "probe"
        probe.write_text("probe\n", encoding="utf-8")
        sign(probe, key)
    return key


def reject_unclean() -> None:
    """End if the checkout differs from its commit."""
    if changed := run("git", "status", "--porcelain"):
        first, *more = changed.splitlines()
        sys.exit(f"The tree is not clean ({first.strip()}, {len(more)} more): commit or stash it.")


def entries_of(changelog: str) -> str:
    """The text under Unreleased."""
    _, heading, rest = changelog.partition(UNRELEASED)
    entries = re.split(r"^## ", rest, maxsplit=1, flags=re.MULTILINE)[0].strip()
    if not heading or not re.search(r"^- ", entries, re.MULTILINE):
        sys.exit("CHANGELOG.md has no entries under Unreleased: there is nothing to release.")
    return entries


def reject_version(version: str, changelog: str) -> None:
    """End if this version cannot follow what was released."""
    if not SEMVER.fullmatch(version):
        sys.exit(
            f"'{version}' is no semantic version: write 1.2.0, or before it 1.2.0-rc.1 (alpha, beta or rc)."
        )
    tags = [tag.removeprefix("v") for tag in run("git", "tag", "--list", "v*").splitlines()]
    # A clone can lack tags.
    released = [*tags, *dict(DATED.findall(changelog))]
    newest = max(filter(SEMVER.fullmatch, released), key=Version, default=None)
    if newest is not None and Version(version) <= Version(newest):
        sys.exit(f"The version {version} is not newer than {newest}, which is released.")
    if f"v{newest}" in run("git", "tag", "--list", "v*").splitlines():
        changed = run("git", "diff", "--name-only", "--diff-filter=a", f"v{newest}", "HEAD", "--", SAMPLES)
        if changed:
            sys.exit(
                f"{changed.splitlines()[0]} is a sample of a released form and was changed: restore it from "
                f"the tag v{newest}, and give the new form a number and a sample of its own."
            )


def date_of(version: str) -> str:
    """The date in the section of a version, from which every timestamp of its build follows."""
    dates = dict(DATED.findall(CHANGELOG.read_text(encoding="utf-8")))
    if version not in dates:
        sys.exit(f"CHANGELOG.md has no section '## [{version}] - DATE'.")
    return dates[version]


def write(file: Path, text: str, *, is_dry: bool) -> None:
    """Replace the text of a file, and print the difference."""
    name, before = file.relative_to(ROOT).as_posix(), file.read_text(encoding="utf-8")
    lines = [one.splitlines(keepends=True) for one in (before, text)]
    sys.stdout.writelines(difflib.unified_diff(*lines, f"a/{name}", f"b/{name}", n=1))
    if not is_dry:
        file.write_text(text, encoding="utf-8")


def folder_of(version: str) -> Path:
    """The folder with the files of a release."""
    return ROOT / "dist" / f"release-{version}"


def build(version: str, date: str, *targets: str, is_dry: bool) -> Path:
    """Build, and return the folder with all files of the release and their checksums."""
    folder, number = folder_of(version), Version(version)
    artefacts = {
        f"coaxial-{number}-py3-none-any.whl": ROOT / "dist" / f"coaxial-{number}-py3-none-any.whl",
        f"coaxial-{number}.tar.gz": ROOT / "dist" / f"coaxial-{number}.tar.gz",
        f"coaxial-{number}.cdx.json": ROOT / "dist" / "coaxial.cdx.json",
        "requirements.lock": ROOT / "requirements.lock",
    }
    epoch_s = int(datetime.fromisoformat(f"{date}T00:00:00+00:00").timestamp())
    command = ["make", "--no-print-directory", *targets]
    print(f"$ SOURCE_DATE_EPOCH={epoch_s} {shlex.join(command)}", flush=True)
    print(f"{folder.relative_to(ROOT)}: {', '.join(artefacts)}, {SUMS}", flush=True)
    if is_dry:
        return folder
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(epoch_s)}
    if subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode != 0:
        sys.exit(f"`{shlex.join(command)}` failed: nothing was released.")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, file in artefacts.items():
        if not file.is_file():
            sys.exit(f"The build made no {file.relative_to(ROOT)}: nothing was released.")
        shutil.copyfile(file, folder / name)
    sums = [f"{hashlib.sha256((folder / name).read_bytes()).hexdigest()}  {name}\n" for name in artefacts]
    (folder / SUMS).write_text("".join(sums), encoding="utf-8")
    return folder


@contextmanager
def undone_on_failure(folder: Path, new: Path, *files: Path) -> Iterator[None]:
    """Restore these files and delete the folder and the new file, if the release fails; others stay."""
    try:
        yield
    except BaseException:
        run("git", "reset", "--quiet", "--", new, *files)
        run("git", "restore", "--", *files)
        new.unlink(missing_ok=True)
        # Signed, it could be taken for a release.
        shutil.rmtree(folder, ignore_errors=True)
        raise


def release(version: str, given: Path | None, *, is_dry: bool) -> None:
    """Make the release of this version from the branch main."""
    changelog, project = CHANGELOG.read_text(encoding="utf-8"), PROJECT.read_text(encoding="utf-8")
    reject_version(version, changelog)
    if (branch := run("git", "branch", "--show-current")) != "main":
        sys.exit(f"The branch is '{branch}': releases are made on main.")
    reject_unclean()
    entries_of(changelog)
    if len(VERSION_LINE.findall(project)) != 1:
        sys.exit('pyproject.toml must have one line `version = "..."`.')
    key = reject_unsigned(given)
    date, head = f"{datetime.now(UTC):%Y-%m-%d}", run("git", "rev-parse", "HEAD")
    tag, title = f"v{version}", f"Coaxial {version}"
    settings = ROOT / SAMPLES / f"settings-{version}.yaml"
    files = (settings, CHANGELOG, PROJECT)
    with undone_on_failure(folder_of(version), *files):
        dated = changelog.replace(UNRELEASED, f"{UNRELEASED}\n## [{version}] - {date}\n", 1)
        write(CHANGELOG, dated, is_dry=is_dry)
        print(f"{settings.relative_to(ROOT)}: config.yaml, which later versions are tested with")
        if not is_dry:
            settings.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / "config.yaml", settings)
        write(PROJECT, VERSION_LINE.sub(f'version = "{version}"', project), is_dry=is_dry)
        folder = build(version, date, "test", "wheel", "sbom", is_dry=is_dry)
        if is_dry:
            print(f"$ ssh-keygen -Y sign -f {key} -n {NAMESPACE} {folder.relative_to(ROOT) / SUMS}")
            print(f"$ git commit --message 'Release {version}'\n$ git tag --sign --message '{title}' {tag}")
            return
        # What was built must be what is tagged.
        status = run("git", "status", "--porcelain", "--untracked-files=all").splitlines()
        expected = {file.relative_to(ROOT).as_posix() for file in files}
        if {line[3:] for line in status} != expected or run("git", "rev-parse", "HEAD") != head:
            sys.exit("The tree was changed during the build: nothing was released.")
        sign(folder / SUMS, key)
        run("git", "add", "--", *files)
        run("git", "commit", "--quiet", "--message", f"Release {version}", "--", *files, shown=True)
        by_key = ["-c", "gpg.format=ssh", "-c", f"user.signingkey={key}"]
        try:
            run("git", *by_key, "tag", "--sign", "--message", title, tag, shown=True)
        except BaseException:
            run("git", "reset", "--quiet", "--soft", head)
            raise
    print(f"Publish {folder.relative_to(ROOT)}, and: git push origin main {tag}")


def build_again(given: Path | None, *, is_dry: bool) -> None:
    """Build the release whose tag is at HEAD; sign it if there is a key."""
    reject_unclean()
    tags = run("git", "tag", "--points-at", "HEAD", "--list", "v*").splitlines()
    if len(tags) != 1:
        sys.exit("Give VERSION=1.2.0, or check out the tag of a release to build it again.")
    version = tags[0].removeprefix("v")
    if VERSION_LINE.findall(PROJECT.read_text(encoding="utf-8")) != [version]:
        sys.exit(f"The tag {tags[0]} and the version in pyproject.toml differ.")
    key = None if given is None else reject_unsigned(given)
    folder = build(version, date_of(version), "wheel", "sbom", is_dry=is_dry)
    if key is not None and not is_dry:
        sign(folder / SUMS, key)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--version", default="")
    parser.add_argument("--key", default="", help="private key of OpenSSH, or a public one of the agent")
    parser.add_argument("--dry-run", action="store_true", help="check, print everything and change nothing")
    given = parser.parse_args()
    key = Path(given.key).expanduser().resolve() if given.key else None
    if given.version:
        release(given.version, key, is_dry=given.dry_run)
    else:
        build_again(key, is_dry=given.dry_run)


if __name__ == "__main__":
    main()

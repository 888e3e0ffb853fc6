"""`make release` in a small repository whose build takes no time, with a throw-away key."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(
    shutil.which("ssh-keygen") is None, reason="needs ssh-keygen (openssh-client)"
)

ROOT = Path(__file__).parents[2]
MAKEFILE = """
test:
	@test ! -e broken
wheel:
	@mkdir -p dist && echo wheel $$SOURCE_DATE_EPOCH >dist/coaxial-0.3.0rc1-py3-none-any.whl
	@echo source >dist/coaxial-0.3.0rc1.tar.gz
	@test ! -e ../commits || git commit -q --allow-empty -m theirs
	@test ! -e ../edits || echo '# edited' >>Makefile
sbom:
	@echo {} >dist/coaxial.cdx.json
"""
CHANGELOG = """# Changelog

## [Unreleased]

### Added

- A `release`.

## [0.2.0] - 2026-01-31

### Added

- The first.
"""
# In the folder of the files.
VERIFY = "ssh-keygen -Y verify -f allowed_signers -I coaxial -n coaxial-release -s SHA256SUMS.sig <SHA256SUMS"
VERIFY_SUMS = "sha256sum --strict -c SHA256SUMS"


def shell(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    # Neither settings nor keys of whoever runs the tests.
    around = {
        "PATH": os.environ["PATH"],
        "HOME": str(folder),
        "GIT_CONFIG_GLOBAL": "/dev/null",
        "GIT_CONFIG_NOSYSTEM": "1",
        **{
            f"GIT_{role}_{part}": "ito@example.org"
            for role in ("AUTHOR", "COMMITTER")
            for part in ("NAME", "EMAIL")
        },
    }
    command_line = ["sh", "-ec", command]
    return subprocess.run(command_line, cwd=folder, env=around, check=False, capture_output=True, text=True)


def released(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return shell(f"{sys.executable} .make/release.py {' '.join(arguments)}", folder)


MADE = ("--version", "0.3.0-rc.1", "--key", "../key")


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A repository on main with entries under Unreleased, beside the key that it allows."""
    folder = tmp_path_factory.mktemp("release") / "checkout"
    for inner in (".make", "docs", "tests/procedure/samples"):
        (folder / inner).mkdir(parents=True)
    shutil.copy(ROOT / ".make" / "release.py", folder / ".make")
    (folder / "Makefile").write_text(MAKEFILE)
    (folder / "CHANGELOG.md").write_text(CHANGELOG)
    (folder / "pyproject.toml").write_text('[project]\nname = "coaxial"\nversion = "0.2.0"\n')
    (folder / "requirements.lock").write_text("numpy==2.2\n")
    (folder / "tests/procedure/samples/case-1.zip").touch()
    (folder / "config.yaml").write_text("camera:\n")
    (folder / ".gitignore").write_text("dist\n")
    done = shell(
        "ssh-keygen -q -t ed25519 -N '' -f ../key; ssh-keygen -q -t ed25519 -N '' -f ../stranger; "
        '(echo "# who"; echo "coaxial $(cat ../key.pub)") >docs/allowed_signers; '
        "git init -q -b main; git add -A; git commit -q -m begin",
        folder,
    )
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def checkout(prepared: Path, tmp_path: Path) -> Path:
    shutil.copytree(prepared.parent, tmp_path / "release")
    return tmp_path / "release" / prepared.name


def test_the_guide_says_how_a_release_is_verified() -> None:
    guide = (ROOT / "docs" / "guide" / "installation.md").read_text(encoding="utf-8")
    assert VERIFY in guide
    assert VERIFY_SUMS in guide


def test_a_release_is_verified_by_its_files_alone_and_no_changed_byte_passes(checkout: Path) -> None:
    done = released(checkout, *MADE)
    assert done.returncode == 0, done.stderr
    dated = (
        r"## \[Unreleased\]\n\n## \[0\.3\.0-rc\.1\] - \d{4}-\d\d-\d\d\n\n### Added\n\n- A `release`\.\n\n## "
    )
    assert re.search(dated, (checkout / "CHANGELOG.md").read_text())
    assert (checkout / "tests/procedure/samples/settings-0.3.0-rc.1.yaml").read_text() == "camera:\n"
    assert 'version = "0.3.0-rc.1"' in (checkout / "pyproject.toml").read_text()
    assert shell("git status --porcelain; git log -1 --format=%s", checkout).stdout == "Release 0.3.0-rc.1\n"
    verify_tag = "git -c gpg.ssh.allowedSignersFile=docs/allowed_signers verify-tag v0.3.0-rc.1"
    tagged = shell(f"git cat-file -t v0.3.0-rc.1; {verify_tag}", checkout)
    assert (tagged.returncode, tagged.stdout) == (0, "tag\n"), tagged.stderr

    files = checkout / "dist" / "release-0.3.0-rc.1"
    shutil.copy(checkout / "docs" / "allowed_signers", files)
    assert shell(f"{VERIFY}; {VERIFY_SUMS}", files).returncode == 0
    names = [line.split()[1] for line in (files / "SHA256SUMS").read_text().splitlines()]
    assert {*names, "SHA256SUMS", "SHA256SUMS.sig", "allowed_signers"} == {
        one.name for one in files.iterdir()
    }
    assert len(names) == 4
    for name in names:
        whole = (files / name).read_bytes()
        (files / name).write_bytes(bytes([whole[0] ^ 1]) + whole[1:])
        assert f"{name}: FAILED" in shell(VERIFY_SUMS, files).stdout
        (files / name).write_bytes(whole)
    sums = (files / "SHA256SUMS").read_text()
    (files / "SHA256SUMS").write_text(("1" if sums[0] == "0" else "0") + sums[1:])
    assert shell(VERIFY, files).returncode != 0

    again = released(checkout)
    assert again.returncode == 0, again.stderr
    assert (files / "SHA256SUMS").read_text() == sums
    assert "0.3.0-rc.1 is not newer than 0.3.0-rc.1" in released(checkout, *MADE).stderr


@pytest.mark.parametrize(
    ("before", "arguments", "sentence"),
    [
        pytest.param(":", ("--version", "1.2"), "'1.2' is no semantic version", id="no-semver"),
        pytest.param(":", ("--version", "0.2.0"), "0.2.0 is not newer than 0.2.0", id="changelog-has-it"),
        pytest.param(
            "git tag v1.0.0",
            ("--version", "1.0.0-rc.2"),
            "1.0.0-rc.2 is not newer than 1.0.0",
            id="tag-is-newer",
        ),
        pytest.param(
            "git tag v0.2.0; echo >>tests/procedure/samples/case-1.zip; git commit -qam other",
            MADE,
            "case-1.zip is a sample of a released form and was changed",
            id="changed-sample",
        ),
        pytest.param("git switch -q -c work", MADE, "The branch is 'work'", id="not-on-main"),
        pytest.param("touch stray", MADE, "The tree is not clean (?? stray, 0 more)", id="unclean"),
        pytest.param(
            "sed -i '/release/d' CHANGELOG.md; git commit -qam none",
            MADE,
            "no entries under Unreleased",
            id="no-entry",
        ),
        pytest.param(":", MADE[:2], "No key to sign with", id="no-key"),
        pytest.param(
            ":", (*MADE[:3], "../stranger"), "stranger is not in docs/allowed_signers", id="unknown-key"
        ),
        pytest.param(
            "touch broken; git add -A; git commit -qm broken", MADE, "nothing was released", id="test-fails"
        ),
        pytest.param("touch ../edits", MADE, "The tree was changed during the build", id="edited-meanwhile"),
        pytest.param(":", (), "Give VERSION=1.2.0", id="neither-version-nor-tag"),
    ],
)
def test_what_is_not_ready_is_refused_with_a_sentence_and_stays_as_it_was(
    checkout: Path, before: str, arguments: tuple[str, ...], sentence: str
) -> None:
    shell(before, checkout)
    state = (
        "git rev-parse HEAD; git tag; cat *.md *.toml; git diff --cached; ls tests/procedure/samples dist/r*"
    )
    was = shell(state, checkout).stdout
    done = released(checkout, *arguments)
    assert done.returncode == 1
    assert sentence in done.stderr
    assert "Traceback" not in done.stderr
    assert shell(state, checkout).stdout == was


def test_a_commit_during_the_build_stays_and_a_tag_that_cannot_be_made_leaves_none(checkout: Path) -> None:
    shell("touch ../commits", checkout)
    assert "The tree was changed during the build" in released(checkout, *MADE).stderr
    assert shell("git log -1 --format=%s; git status --porcelain", checkout).stdout == "theirs\n"
    # Beside a tag of the name v0.3.0-rc.1/x there can be none of its folder's name.
    shell("rm ../commits; git tag v0.3.0-rc.1/x", checkout)
    assert "tag --sign" in released(checkout, *MADE).stderr
    assert shell("git log -1 --format=%s; git status --porcelain", checkout).stdout == "theirs\n"
    assert list((checkout / "dist").glob("release-*")) == []


def test_a_dry_run_prints_everything_and_changes_nothing(checkout: Path) -> None:
    done = released(checkout, *MADE, "--dry-run")
    assert done.returncode == 0, done.stderr
    for printed in (
        "+## [0.3.0-rc.1] - ",
        '+version = "0.3.0-rc.1"',
        "make --no-print-directory test wheel sbom",
    ):
        assert printed in done.stdout
    for printed in (
        "coaxial-0.3.0rc1.tar.gz",
        "-n coaxial-release",
        "tag --sign --message 'Coaxial 0.3.0-rc.1'",
    ):
        assert printed in done.stdout
    assert shell("git status --porcelain --ignored; git tag", checkout).stdout == ""

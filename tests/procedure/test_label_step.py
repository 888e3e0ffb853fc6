"""A segmentation of the vertebrae through the API: taken in, used, and rejected."""

import functools
from typing import Any

import numpy as np

from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY, opened, sent
from tests.procedure.uploads import nifti, phantom, scanned
from tests.server.imaging.made_labels import label_nifti
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume


@functools.cache
def labelled(level: str = "L3") -> LabelVolume:
    """True label of the phantom's vertebra in the voxels of its CT."""
    volume = scanned()
    index = np.argwhere(np.ones(volume.hu.shape, dtype=bool))[:, ::-1]
    inside = phantom().bone_distance_mm(volume.lps_from_index(index)) < 0.0
    labels = inside.reshape(volume.hu.shape) * np.uint8(CLASS_OF_LEVEL[level])
    return LabelVolume(labels=labels, lps_from_ijk=volume.lps_from_ijk, voxel_mm=1.0)


def send_labels(server: Server, content: bytes, **query: str) -> Any:  # noqa: ANN401  JSON
    job = server.ask("POST", "/api/labels", 202, content=content, params={**BY, **query})
    return server.done(job)


def test_labels_become_a_document_of_the_case_that_depends_on_its_ct(server: Server) -> None:
    opened(server)
    content = label_nifti(labelled())
    assert server.ask("POST", "/api/labels", 409, content=content, params=BY)["code"] == "CT_MISSING"
    assert server.ask("GET", "/api/labels", 409)["code"] == "LABELS_NOT_STORED"
    sent(server, nifti(scanned()))
    done = send_labels(server, content)
    assert done["state"] == "done", done["problem"]
    made = server.ask("GET", "/api/labels", 200)
    assert made["heading"]["current"]
    assert made["heading"]["made_by"] == BY["made_by"]
    ct = server.ask("GET", "/api/ct", 200)["heading"]["id"]
    assert made["heading"]["depends_on"] == [ct]
    (one,) = made["vertebrae"]
    assert one["level"] == "L3"
    assert one["is_cut"], "the phantom's processes leave its CT"
    file = server.door.get("/api/labels.nii.gz")
    assert file.status_code == 200
    again = {"If-None-Match": file.headers["etag"]}
    assert server.door.get("/api/labels.nii.gz", headers=again).status_code == 304
    # What the case has can be sent again, and gives the same.
    assert send_labels(server, file.content)["result"]["sha256"] == made["sha256"]
    # Another CT makes them out of date.
    sent(server, nifti(scanned()))
    assert not server.ask("GET", "/api/labels", 200)["heading"]["current"]


def test_wrong_labels_leave_nothing_behind(server: Server) -> None:
    opened(server)
    sent(server, nifti(scanned()))
    unnamed = server.ask("POST", "/api/labels", 422, content=b"x", params={**BY, "names": "29:liver"})
    assert unnamed["code"] == "LABEL_NAMES_INVALID"
    failed = send_labels(server, b"hello")
    assert failed["problem"]["code"] == "LABELS_MISSING"
    assert server.ask("GET", "/api/labels", 409)["code"] == "LABELS_NOT_STORED"

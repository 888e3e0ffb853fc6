import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { getPlanCatalogue, type LandmarkMessage, putPlanVertebraeByNameLandmarks } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { SetupCheckNote } from "../../SetupCheckNote";
import { VertebraChooser } from "../pedicle/VertebraChooser";
import { CursorPad } from "../slices/CursorPad";
import { useSlices } from "../slices/SlicesContext";
import { usePlanning } from "../state/PlanContext";
import type { Landmark } from "../state/shape";
import { LandmarkNames } from "./LandmarkNames";
import { RehearsedLandmarks } from "./RehearsedLandmarks";

/** Landmarks: points of the bone that can be found on the patient; set at the cross, named, listed. */
export function LandmarksPart(): ReactNode {
  const texts = useTexts().plan.landmarks;
  const { vertebra, change, busy } = usePlanning();
  const { look, goTo } = useSlices();
  const catalogue = useQuery((signal) => getPlanCatalogue({ signal })).data;
  const [isNaming, setNaming] = useState(false);
  if (vertebra === null) return <p>{texts.noVertebra}</p>;
  const { name, landmarks } = vertebra;
  const put = (next: readonly Landmark[]): void => {
    const body = next.map((one): LandmarkMessage => ({
      name: one.name,
      point_lps_mm: [...one.point_lps_mm],
    }));
    void change((by) =>
      putPlanVertebraeByNameLandmarks({ path: { name }, body: { ...by, landmarks: body } }),
    );
  };
  const minLandmarks = catalogue?.min_landmarks ?? null;
  const isEnough = minLandmarks !== null && landmarks.length >= minLandmarks;
  return (
    <>
      <VertebraChooser />
      <p>{texts.hint}</p>
      <p
        className={minLandmarks === null ? "soft" : isEnough ? "enough" : "warning"}
        data-testid="landmark-count"
      >
        {landmarks.length} {texts.set}
        {minLandmarks !== null && ` · ${texts.needed} ${minLandmarks}`} · {texts.better}
      </p>
      <SetupCheckNote />
      <CursorPad />
      <Button
        size="xl"
        fullWidth
        disabled={busy}
        data-testid="set-landmark"
        onClick={() => {
          setNaming(true);
        }}
      >
        {texts.setHere}
      </Button>
      <LandmarkNames
        opened={isNaming}
        usedNames={landmarks.map((one) => one.name)}
        onClose={() => {
          setNaming(false);
        }}
        onName={(named) => {
          setNaming(false);
          put([...landmarks, { name: named, point_lps_mm: look.cursor }]);
        }}
      />
      <ol className="landmarks">
        {landmarks.map((one) => (
          <li key={one.name}>
            <button
              type="button"
              className="landmark-name"
              aria-label={`${texts.show}: ${one.name}`}
              onClick={() => {
                goTo(one.point_lps_mm);
              }}
            >
              {one.name}
            </button>
            <button
              type="button"
              disabled={busy}
              aria-label={`${texts.moveHere}: ${one.name}`}
              title={texts.moveHere}
              onClick={() => {
                put(
                  landmarks.map((other) => (other === one ? { ...one, point_lps_mm: look.cursor } : other)),
                );
              }}
            >
              <Icon name="crosshair" />
            </button>
            <button
              type="button"
              disabled={busy}
              aria-label={`${texts.remove}: ${one.name}`}
              title={texts.remove}
              onClick={() => {
                put(landmarks.filter((other) => other !== one));
              }}
            >
              <Icon name="cross" />
            </button>
          </li>
        ))}
      </ol>
      <RehearsedLandmarks busy={busy} onTake={put} />
    </>
  );
}

import { Button, SegmentedControl } from "@mantine/core";
import { useEffect, useRef, useState, useSyncExternalStore, type ReactNode } from "react";
import { postRegistrationNeedlesOverlay } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { interpolate } from "../../../texts/interpolate";
import type { PlannedVertebra } from "../planReader";
import { RegistrationRejection } from "../RegistrationRejection";
import { LiveStage } from "../LiveStage";
import { needleRequestBody, type NeedleRequest } from "./order";
import { LineLayer } from "./LineLayer";
import { MarkLayer } from "./MarkLayer";
import { MarkPanel } from "./MarkPanel";
import type { Mark } from "./marks";
import { OverlayController } from "./overlayController";
import { OverlayPanel } from "./OverlayPanel";
import { PlacesForm } from "./PlacesForm";
import { ProposalPanel, type Proposal } from "./ProposalPanel";
import { SliceLayer } from "./SliceLayer";
import { useHandOnStage } from "./useHandOnStage";

type Mode = "overlay" | "proposal" | "mark";

interface NeedlesWorkProps {
  order: NeedleRequest;
  vertebra: PlannedVertebra;
  onRuler: () => void;
  onLandmarks: (landmarks: string[]) => void;
}

/** Slice overlay, detected needles, or needles marked by hand. */
export function NeedlesWork({ order, vertebra, onRuler, onLandmarks }: NeedlesWorkProps): ReactNode {
  const texts = useTexts().registration.needles;
  const [controller] = useState(
    () =>
      new OverlayController((overlay) =>
        postRegistrationNeedlesOverlay({ body: { ...needleRequestBody(order), overlay, marked: [] } }),
      ),
  );
  const state = useSyncExternalStore(controller.subscribe, controller.state);
  const stage = useRef<HTMLDivElement>(null);
  const picture = useRef<HTMLCanvasElement>(null);
  const [mode, setMode] = useState<Mode>("overlay");
  const [isFrozen, setIsFrozen] = useState(false);
  const [placing, setPlacing] = useState(false);
  const [picked, setPicked] = useState<Proposal | null>(null);
  const [marks, setMarks] = useState<Mark[]>([]);
  useEffect(() => {
    controller.start();
    return () => {
      controller.stop();
    };
  }, [controller]);
  useHandOnStage(controller, stage, mode === "overlay");

  const names = state.laid?.needles.map((one) => one.name) ?? [];
  return (
    <div className="work" data-testid="needles-work">
      <div className="work-main">
        <LiveStage stage={stage} picture={picture} isFrozen={isFrozen} onFreeze={setIsFrozen}>
          {mode === "overlay" && state.laid?.slice != null && (
            <SliceLayer controller={controller} slice={state.laid.slice} vertebra={vertebra.name} />
          )}
          {mode === "overlay" && <LineLayer controller={controller} names={names} />}
          {mode === "proposal" && picked !== null && (
            <MarkLayer
              marks={picked.marked.map((one) => ({ entry_px: one.entry_px, head_px: one.head_px }))}
              names={picked.laid.needles.map((one) => one.name)}
              lines={picked.laid.needles.map((one) => one.line_px)}
            />
          )}
          {mode === "mark" && <MarkLayer marks={marks} names={names} />}
        </LiveStage>
        <p className="row quiet">
          {interpolate(texts.seenFrom, {
            v: order.view.vertical_mm,
            h: order.view.horizontal_mm,
            places: order.landmarks.length === 0 ? texts.onLines : order.landmarks.join(", "),
          })}
          <Button size="md" variant="default" onClick={onRuler} data-testid="needles-ruler">
            {texts.changeRuler}
          </Button>
          <Button
            size="md"
            variant="default"
            data-testid="needles-places"
            onClick={() => {
              setPlacing(!placing);
            }}
          >
            {texts.changePlaces}
          </Button>
        </p>
        {placing && <PlacesForm vertebra={vertebra} chosen={order.landmarks} onChosen={onLandmarks} />}
      </div>
      <div className="work-side">
        <SegmentedControl
          size="lg"
          fullWidth
          aria-label={texts.how}
          value={mode}
          onChange={(value) => {
            setMode(value);
          }}
          data={[
            { value: "overlay", label: texts.overlay },
            { value: "proposal", label: texts.proposal },
            { value: "mark", label: texts.mark },
          ]}
        />
        <RegistrationRejection rejection={state.rejection} />
        {mode === "overlay" && (
          <OverlayPanel
            controller={controller}
            state={state}
            order={order}
            isFrozen={isFrozen}
            onRelease={() => {
              setIsFrozen(false);
            }}
          />
        )}
        {mode === "proposal" && (
          <ProposalPanel
            order={order}
            picked={picked}
            isFrozen={isFrozen}
            onPick={setPicked}
            onAdjust={(proposal) => {
              setMarks(proposal.marked.map((one) => ({ entry_px: one.entry_px, head_px: one.head_px })));
              setMode("mark");
            }}
          />
        )}
        {mode === "mark" && (
          <MarkPanel
            order={order}
            names={names}
            marks={marks}
            onMarks={setMarks}
            stage={stage}
            picture={picture}
            isFrozen={isFrozen}
          />
        )}
      </div>
    </div>
  );
}

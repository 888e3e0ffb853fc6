import { Button } from "@mantine/core";
import { useRef, type ReactNode } from "react";
import { SignedIn } from "../app/SignedIn";
import { HelpButton } from "../help/HelpButton";
import { useSession } from "../app/session";
import { useTexts } from "../texts/TextsContext";
import { unfit } from "./noCamera";
import { StreamFacts } from "./StreamFacts";
import { StreamProblems } from "./StreamProblems";
import { useCameraStream } from "./useCameraStream";

/** This device as camera: preview, button and transfer state. */
export function CameraPage(): ReactNode {
  const all = useTexts();
  const texts = all.phone;
  const { session } = useSession();
  const video = useRef<HTMLVideoElement>(null);
  const { sending, start, stop } = useCameraStream(video);
  const lacks = unfit(
    isSecureContext,
    "mediaDevices" in navigator,
    "requestVideoFrameCallback" in HTMLVideoElement.prototype,
  );
  const isOn = sending.state !== "idle";
  return (
    <main className="phone" data-testid="phone" data-state={sending.state}>
      <header className="phone-top">
        <h1>{texts.title}</h1>
        <HelpButton place="phone" />
        <SignedIn />
      </header>
      <div className="phone-preview" data-on={isOn}>
        <video ref={video} playsInline muted aria-label={texts.preview} />
        {!isOn && <p>{texts.noPreview}</p>}
      </div>
      <div className="phone-panel">
        <p className="phone-state" role="status">
          {texts.state[sending.state]}
        </p>
        <StreamProblems sending={sending} lacks={lacks} />
        {isOn ? <StreamFacts sending={sending} /> : <p className="phone-lead">{texts.lead}</p>}
        <Button
          className="phone-button"
          variant={isOn ? "default" : "filled"}
          fullWidth
          disabled={lacks !== null}
          onClick={isOn ? stop : start}
          data-testid="phone-button"
        >
          {isOn ? texts.stop : texts.start}
        </Button>
        <details>
          <summary>{texts.limits}</summary>
          <ul>
            {Object.entries(texts.limitList).map(([key, text]) => (
              <li key={key}>{text}</li>
            ))}
          </ul>
        </details>
        <footer>
          {/* A full page load: only the camera page's document may request a camera. */}
          {session.state === "in" && session.who.role === "operator" && <a href="/">{texts.dashboard}</a>}
          <span className="notice">{all.notice}</span>
        </footer>
      </div>
    </main>
  );
}

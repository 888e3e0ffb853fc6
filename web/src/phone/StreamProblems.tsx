import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { sentence } from "../operator/parts/format";
import { useTexts } from "../texts/TextsContext";
import type { Problem } from "./messages";
import type { NoCamera } from "./noCamera";
import type { CameraStream } from "./useCameraStream";

/** Problems of this device in the page's words, and of the server in its own. */
export function StreamProblems({
  sending,
  lacks,
}: {
  sending: CameraStream;
  lacks: NoCamera | null;
}): ReactNode {
  const texts = useTexts().phone;
  const noCamera = lacks ?? sending.noCamera;
  const problem = sending.rejected ?? sending.note?.problem ?? null;
  const isOn = sending.state !== "idle";
  return (
    <>
      {noCamera !== null && (
        <Alert className="rejection" role="alert" title={texts.noCamera[noCamera].title}>
          {texts.noCamera[noCamera].sentence}
        </Alert>
      )}
      {problem !== null && <ServerProblem problem={problem} />}
      {isOn && !sending.hasWakeLock && <p className="phone-warning">{texts.screenOff}</p>}
    </>
  );
}

function ServerProblem({ problem }: { problem: Problem }): ReactNode {
  return (
    <Alert
      className="rejection"
      role="alert"
      title={<span lang="en">{sentence(problem.message)}</span>}
      data-testid="phone-problem"
    >
      <span lang="en">{problem.remedy}</span> <code>{problem.code}</code>
    </Alert>
  );
}

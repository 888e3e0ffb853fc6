import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { sentence } from "../operator/parts/shown";
import { useWords } from "../words/WordsContext";
import type { Trouble } from "./messages";
import type { NoCamera } from "./noCamera";
import type { Sending } from "./useSending";

/** What is wrong and what to do: of this device in the page's words, of the server in its own. */
export function SendingTroubles({ sending, lacks }: { sending: Sending; lacks: NoCamera | null }): ReactNode {
  const words = useWords().phone;
  const noCamera = lacks ?? sending.noCamera;
  const told = sending.refused ?? sending.note?.trouble ?? null;
  const isOn = sending.state !== "idle";
  return (
    <>
      {noCamera !== null && (
        <Alert className="refusal" role="alert" title={words.noCamera[noCamera].title}>
          {words.noCamera[noCamera].sentence}
        </Alert>
      )}
      {told !== null && <Told trouble={told} />}
      {isOn && !sending.screenKept && <p className="phone-warning">{words.screenOff}</p>}
    </>
  );
}

function Told({ trouble }: { trouble: Trouble }): ReactNode {
  return (
    <Alert
      className="refusal"
      role="alert"
      title={<span lang="en">{sentence(trouble.message)}</span>}
      data-testid="phone-trouble"
    >
      <span lang="en">{trouble.remedy}</span> <code>{trouble.code}</code>
    </Alert>
  );
}

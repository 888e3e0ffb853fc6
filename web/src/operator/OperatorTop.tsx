import type { ReactNode } from "react";
import { ViewSwitch } from "../app/ViewSwitch";
import { Brand } from "../panes/Brand";
import { LiveStatus } from "../panes/LiveStatus";
import { RecordControl } from "../recording/RecordControl";
import { useTexts } from "../texts/TextsContext";
import { useProcedure } from "../app/procedure";

/** Header: open case, state of tracking, camera and server, and links to the other views. */
export function OperatorTop(): ReactNode {
  const texts = useTexts();
  const { data, rejection } = useProcedure();
  const unknown = rejection === null ? texts.rest.loading : texts.theatre.unknown;
  return (
    <header className="operator-top">
      <Brand />
      <p className="operator-case" data-testid="open-case">
        <span>{texts.theatre.case}</span>{" "}
        <strong>{data === null ? unknown : (data.case_name ?? texts.theatre.noCase)}</strong>
      </p>
      <RecordControl />
      <LiveStatus withTracking />
      <ViewSwitch />
    </header>
  );
}

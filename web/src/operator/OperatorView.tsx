import type { ReactNode } from "react";
import { Redirect, useLocation, useSearch } from "wouter";
import { AlarmBand } from "../alarms/AlarmBand";
import { ConfirmRestart } from "../app/ConfirmRestart";
import { ConsentQuestion } from "../recording/ConsentQuestion";
import { QueryStatus } from "../rest/QueryStatus";
import { useTexts } from "../texts/TextsContext";
import { OperatorTop } from "./OperatorTop";
import { pageAt, PAGES } from "./pages";
import { useProcedure } from "../app/procedure";
import { WithStepActions } from "./StepActions";
import { SinkNotes } from "./SinkNotes";
import { StepHead } from "./StepHead";
import { StepRail } from "./StepRail";

/** The operator's view: the procedure step by step. */
export function OperatorView(): ReactNode {
  const texts = useTexts();
  const [path] = useLocation();
  const search = useSearch();
  const procedure = useProcedure();
  const { data, rejection } = procedure;
  // Before the first answer the next step is unknown; without one the page starts with the list of cases.
  const next =
    data === null ? (rejection === null ? null : "case") : ((data.case_id && data.next_step) ?? "case");
  const named = pageAt(path);
  const page = named ?? PAGES.find((one) => one.step === next || one.name === next) ?? null;
  // From here on the address names the page: otherwise it would change under a finger as soon as another step is next
  // or the server does not answer.
  if (named === null && data !== null && page !== null)
    return <Redirect to={`/operator/${page.name}${search === "" ? "" : `?${search}`}`} replace />;
  return (
    <div className="operator">
      <a className="skip" href="#step">
        {texts.operator.skip}
      </a>
      <OperatorTop />
      <AlarmBand />
      {/* With the figures where they are shown. */}
      {page?.name !== "navigate" && <ConfirmRestart />}
      <ConsentQuestion />
      <div className="operator-body">
        <StepRail now={page} />
        <main id="step" className="step" tabIndex={-1}>
          {page === null ? (
            <QueryStatus query={procedure} />
          ) : (
            <>
              <StepHead page={page} />
              <WithStepActions key={page.name}>
                <page.Page />
              </WithStepActions>
            </>
          )}
        </main>
      </div>
      <SinkNotes />
    </div>
  );
}

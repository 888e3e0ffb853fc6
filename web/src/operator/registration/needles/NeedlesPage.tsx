import { useState, type ReactNode } from "react";
import { getPlan } from "../../../api";
import { EmptyState } from "../../../panes/EmptyState";
import { PageLink } from "../../../rest/PageLink";
import { QueryStatus } from "../../../rest/QueryStatus";
import { useQuery } from "../../../rest/useQuery";
import { useTexts } from "../../../texts/TextsContext";
import { useCaseId } from "../../../app/procedure";
import { plannedVertebrae } from "../planReader";
import { RegistrationRejection } from "../RegistrationRejection";
import { NeedlesWork } from "./NeedlesWork";
import { PlacesForm } from "./PlacesForm";
import { RulerForm } from "./RulerForm";
import { FIRST_VIEW, storeView, storedView } from "./ruler";
import type { NeedleRequest } from "./order";

/** Registration with three needles: first camera position and needle places, then the picture. */
export function NeedlesPage(): ReactNode {
  const texts = useTexts().registration.needles;
  const caseId = useCaseId() ?? "";
  const plan = useQuery((signal) => getPlan({ signal }));
  const known = storedView(caseId);
  const [view, setView] = useState(known ?? FIRST_VIEW);
  const [measured, setMeasured] = useState(known !== null);
  const [chosen, setChosen] = useState<string[] | null>(null);
  if (plan.data === null) return <QueryStatus query={plan} Note={RegistrationRejection} />;
  const name = plan.data.active_channel?.vertebra ?? "";
  const vertebra = plannedVertebrae(plan.data.plan).find((one) => one.name === name);
  if (vertebra === undefined)
    return (
      <EmptyState drawing="plan" sentence={texts.noVertebra}>
        <PageLink page="plan" />
      </EmptyState>
    );
  const landmarks = chosen ?? (vertebra.hasReference ? [] : null);
  if (!measured || landmarks === null)
    return (
      <>
        <p className="quiet">{texts.intro}</p>
        <RulerForm
          view={view}
          onView={setView}
          middleMm={[0, 40, 0]}
          done={measured}
          onDone={() => {
            storeView(caseId, view);
            setMeasured(true);
          }}
        />
        {measured && <PlacesForm vertebra={vertebra} chosen={[]} onChosen={setChosen} />}
      </>
    );
  const order: NeedleRequest = { view, landmarks };
  return (
    <NeedlesWork
      key={JSON.stringify(order)}
      order={order}
      vertebra={vertebra}
      onRuler={() => {
        setMeasured(false);
      }}
      onLandmarks={setChosen}
    />
  );
}

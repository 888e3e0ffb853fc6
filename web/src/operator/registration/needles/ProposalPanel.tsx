import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useAction } from "../../../rest/useAction";
import { postRegistrationNeedlesProposal, type ProposalMessage } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { RegistrationRejection } from "../RegistrationRejection";
import { ConcludeNeedles } from "./ConcludeNeedles";
import type { NeedleRequest } from "./order";
import { needleRequestBody } from "./order";
import { ProposalCard } from "./ProposalCard";

export type Proposal = ProposalMessage;

interface ProposalPanelProps {
  order: NeedleRequest;
  picked: Proposal | null;
  isFrozen: boolean;
  onPick: (proposal: Proposal | null) => void;
  onAdjust: (proposal: Proposal) => void;
}

/** Detected needles with their likely assignments of names; the user must pick one. */
export function ProposalPanel({ order, picked, isFrozen, onPick, onAdjust }: ProposalPanelProps): ReactNode {
  const texts = useTexts().registration.proposal;
  const [proposals, setProposals] = useState<Proposal[] | null>(null);
  const finding = useAction();
  return (
    <section className="card">
      <p className="warning">▲ {texts.oftenWrong}</p>
      <Button
        size="lg"
        loading={finding.busy}
        data-testid="find-needles"
        onClick={() => {
          onPick(null);
          setProposals(null);
          void finding.run(async () => {
            const rehearsal = await postRegistrationNeedlesProposal({ body: needleRequestBody(order) });
            setProposals(rehearsal.proposals);
          });
        }}
      >
        {proposals === null ? texts.find : texts.findAgain}
      </Button>
      <RegistrationRejection rejection={finding.rejection} />
      {proposals !== null && (
        <>
          <p>{texts.pick}</p>
          <ol className="proposals">
            {proposals.map((one, index) => (
              <ProposalCard
                key={one.laid.image_number + index}
                number={index + 1}
                proposal={one}
                isPicked={one === picked}
                onPick={() => {
                  onPick(one);
                }}
              />
            ))}
          </ol>
        </>
      )}
      {picked !== null && (
        <>
          <Button
            size="lg"
            variant="default"
            onClick={() => {
              onAdjust(picked);
            }}
          >
            {texts.adjust}
          </Button>
          <ConcludeNeedles order={order} marked={picked.marked} picked isFrozen={isFrozen} disabled={false}>
            {texts.conclude}
          </ConcludeNeedles>
        </>
      )}
    </section>
  );
}

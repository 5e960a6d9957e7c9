// The lanes as the handshake of the paper's plan sees them: three turns, each of any length, then the last result.
module subject_spmv_array #(
    parameter ROM_DIR = ""
) (
    input wire clock,
    input wire reset,
    input wire we_start,
    input wire co_start,
    input wire op_start,
    output wire turn_issued,
    output wire drained,
    output wire idle,
    output wire [2:0] phase_now
);

    localparam [2:0] IDLE = 3'd0, WE = 3'd1, TO_CO = 3'd2, CO = 3'd3, TO_OP = 3'd4, OP = 3'd5, DRAIN = 3'd6;

    reg [2:0] phase = IDLE;
    wire go = $anyseq;

    assign phase_now = phase;
    assign idle = (phase == IDLE);
    assign turn_issued = go && ((phase == WE) || (phase == CO) || (phase == OP));
    assign drained = go && (phase == DRAIN);

    always @(posedge clock) begin
        case (phase)
            IDLE: if (we_start) phase <= WE;
            TO_CO: if (co_start) phase <= CO;
            TO_OP: if (op_start) phase <= OP;
            DRAIN: if (go) phase <= IDLE;
            default: if (go) phase <= phase + 3'd1;
        endcase
        if (reset) begin
            phase <= IDLE;
        end
    end

    // A turn begins when the one before has passed it on, not otherwise
    always @(posedge clock) begin
        if (!reset) begin
            assert (!we_start || (phase == IDLE));
            assert (!co_start || (phase == TO_CO));
            assert (!op_start || (phase == TO_OP));
        end
    end

endmodule

// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The records of sptfra_regions_blobs forwards, which is backwards in time, a taxel a cycle with a step between rows:
// the number of each taxel's body, 0 to 11 in the order of their first taxels, 15 where there is none; and how many
// bodies there are. At a blob's first taxel its sum is whole.
//
// Names are looked up where a run begins. One that a taxel above has joined belongs to that one's blob; any other is of
// a new blob. Each name that is noted is looked up once, so that none is left behind the last taxel.
//
// From a record to its number: 2 cycles; to a new blob for sptfra_regions_largest: 1.

`default_nettype none

module sptfra_regions_bodies #(
    // Bits of a sum, of a number of taxels, of a name
    parameter SUM_BITS = 33,
    parameter COUNT_BITS = 8,
    parameter LABEL_WIDTH = 4,
    // Derived
    parameter RECORD_BITS = SUM_BITS + COUNT_BITS + 2 * LABEL_WIDTH + 2
) (
    input  wire clock,
    input  wire reset,
    input  wire clear, // a frame begins
    input  wire [SUM_BITS-1:0] least, // held
    // Records: between rows, and before and behind the walk, nothing is there
    input  wire there,
    input  wire [RECORD_BITS-1:0] record,
    // Taxels
    output reg  numbered,
    output wire [3:0] number,
    // Blobs
    output wire [SUM_BITS-1:0] sum,
    output reg  begins, // a cycle behind its sum, with
    output reg  [COUNT_BITS-1:0] taxels,
    output wire [3:0] body,
    // Of all taxels so far
    output wire [3:0] bodies
);

    localparam NAMES = 1 << LABEL_WIDTH;
    localparam [3:0] NONE = 4'd15;
    localparam [NAMES-1:0] FIRST = 1;

    // ---- Stage 1: whether the sum is a body's
    reg [RECORD_BITS-1:0] record_1;
    reg there_1;
    reg touches_1;
    reg is_body_1;
    wire joins_1 = record_1[1] && touches_1;
    wire [LABEL_WIDTH-1:0] label_1 = record_1[2 +: LABEL_WIDTH];
    wire [LABEL_WIDTH-1:0] joined_1 = record_1[2+LABEL_WIDTH +: LABEL_WIDTH];

    assign sum = record_1[2+2*LABEL_WIDTH+COUNT_BITS +: SUM_BITS];

    always @(posedge clock) begin
        there_1 <= there;
        touches_1 <= there && record[0];
        record_1 <= record;
        is_body_1 <= (record[2+2*LABEL_WIDTH+COUNT_BITS +: SUM_BITS] >= least);
        if (reset) begin
            there_1 <= 1'b0;
            touches_1 <= 1'b0;
        end
    end

    // ---- Stage 2: which it is
    (* ram_style = "distributed" *) reg [3:0] numbers [0:NAMES-1];
    reg [NAMES-1:0] noted; // names with a number
    reg [3:0] found; // bodies
    reg any; // taxel that touches
    reg touches_2;
    reg joins_2;
    reg [LABEL_WIDTH-1:0] joined_2;
    reg [3:0] number_2;
    wire run = touches_1 && !touches_2; // begins
    wire known = noted[label_1];
    wire new_body = run && !known && is_body_1;
    wire [3:0] first = known ? numbers[label_1] : (is_body_1 ? found : NONE);

    assign number = touches_2 ? number_2 : NONE;
    assign body = number_2;
    assign bodies = ((found == 4'd0) && any) ? 4'd1 : found;

    always @(posedge clock) begin
        numbered <= there_1;
        touches_2 <= touches_1;
        joins_2 <= joins_1;
        joined_2 <= joined_1;
        taxels <= record_1[2+2*LABEL_WIDTH +: COUNT_BITS];
        begins <= run && !known;
        if (run) begin
            number_2 <= first;
        end
        if (joins_2) begin
            numbers[joined_2] <= number_2;
        end
        noted <= (noted | (joins_2 ? (FIRST << joined_2) : {NAMES{1'b0}})) &
            ~(run ? (FIRST << label_1) : {NAMES{1'b0}});
        found <= found + {3'd0, new_body};
        any <= any || touches_1;
        if (clear) begin
            found <= 4'd0;
            any <= 1'b0;
        end
        if (reset) begin
            noted <= {NAMES{1'b0}};
            numbered <= 1'b0;
            begins <= 1'b0;
            touches_2 <= 1'b0;
            joins_2 <= 1'b0;
        end
    end

    wire _unused = &{1'b0, record_1[0]};

`ifdef SIMULATION
    always @(posedge clock) begin
        if (!reset && clear && (noted != {NAMES{1'b0}})) begin
            $fdisplay(32'h80000002, "%m: a name of the last frame was not looked up");
            $finish;
        end
    end
`endif

endmodule

`default_nettype wire

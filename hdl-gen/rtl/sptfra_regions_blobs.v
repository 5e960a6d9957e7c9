// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A frame's taxels backwards, one a cycle: which of them touch, the name of each one's blob, and what that blob has
// become, its sum and its taxels. Behind the last taxel it is known from which sum on a blob is a body: 5/64 of all.
//
// A taxel touches above 5/64 of the largest. Names are those of sptfra_blob_labels; what joins two is told, so that
// whoever reads the taxels forwards can tell which names were one.
//
// From a step to its record: WEIGHT_LATENCY + 4 cycles; to the least sum that has its weight: as many.

`default_nettype none

module sptfra_regions_blobs #(
    // Taxels along x
    parameter COLUMNS = 10,
    // Bits of |w|, of a sum, of a number of taxels
    parameter DATA_BITS = 26,
    parameter SUM_BITS = 33,
    parameter COUNT_BITS = 8,
    // Cycles from a step to its weight
    parameter WEIGHT_LATENCY = 4,
    // Derived
    parameter LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2,
    parameter RECORD_BITS = SUM_BITS + COUNT_BITS + 2 * LABEL_WIDTH + 2
) (
    input  wire clock,
    input  wire reset,
    input  wire clear, // a frame begins, before its first step
    input  wire [DATA_BITS-1:0] largest, // held from clear on
    // Steps, and the weight of each one that is a taxel
    input  wire step,
    input  wire border,
    input  wire [LABEL_WIDTH-1:0] fresh,
    input  wire [DATA_BITS-1:0] weight,
    // Taxels
    output wire there,
    output wire [RECORD_BITS-1:0] record, // sum, taxels, joined name, own name, joins, touches
    // Of all taxels so far
    output reg  [SUM_BITS-1:0] least
);

    generate
        if (SUM_BITS <= DATA_BITS) begin : gen_check_sum
            sptfra_error_sums_must_be_wider_than_weights invalid ();
        end
        if (WEIGHT_LATENCY < 1) begin : gen_check_latency
            sptfra_error_a_weight_comes_after_its_address invalid ();
        end
    endgenerate

    localparam CONTROL_BITS = LABEL_WIDTH + 2;
    localparam TOTAL = SUM_BITS + COUNT_BITS;

    // ---- Until the weight is there
    reg [CONTROL_BITS*WEIGHT_LATENCY-1:0] controls;
    wire [CONTROL_BITS-1:0] control = controls[CONTROL_BITS*(WEIGHT_LATENCY-1) +: CONTROL_BITS];
    wire [CONTROL_BITS*(WEIGHT_LATENCY+1)-1:0] longer = {controls, fresh, border, step};

    always @(posedge clock) begin
        controls <= longer[CONTROL_BITS*WEIGHT_LATENCY-1:0];
        if (reset) begin
            controls <= {(CONTROL_BITS*WEIGHT_LATENCY){1'b0}};
        end
    end

    // ---- Stage 1: whether it touches
    wire [DATA_BITS+2:0] largest_5 = {1'b0, largest, 2'b00} + {3'b000, largest};
    reg [DATA_BITS-1:0] limit;
    reg [DATA_BITS-1:0] weight_1;
    reg [LABEL_WIDTH-1:0] fresh_1;
    reg step_1;
    reg taxel_1;
    reg touches_1;

    always @(posedge clock) begin
        limit <= {3'b000, largest_5[DATA_BITS+2:6]};
        weight_1 <= weight;
        fresh_1 <= control[2 +: LABEL_WIDTH];
        step_1 <= control[0];
        taxel_1 <= control[0] && !control[1];
        touches_1 <= !control[1] && (weight > limit);
        if (reset) begin
            step_1 <= 1'b0;
            taxel_1 <= 1'b0;
        end
    end

    // ---- Of all: the sum, and 5/64 of it, rounded up
    reg [SUM_BITS-1:0] total;
    reg [SUM_BITS+2:0] total_5;
    wire [SUM_BITS+2:0] rounded = total_5 + {{(SUM_BITS-3){1'b0}}, 6'd63};

    always @(posedge clock) begin
        if (taxel_1) begin
            total <= total + {{(SUM_BITS-DATA_BITS){1'b0}}, weight_1};
        end
        if (clear) begin
            total <= {SUM_BITS{1'b0}};
        end
        total_5 <= {1'b0, total, 2'b00} + {3'b000, total};
        least <= {3'b000, rounded[SUM_BITS+2:6]};
    end

    // ---- Stage 2: its blob
    wire counts_2;
    wire begins_2;
    wire [LABEL_WIDTH-1:0] label_2;
    wire joins_2;
    wire [LABEL_WIDTH-1:0] joined_2;
    reg [DATA_BITS-1:0] weight_2;
    reg taxel_2;

    sptfra_blob_labels #(
        .COLUMNS (COLUMNS)
    ) blob_labels (
        .clock   (clock),
        .clear   (clear),
        .step    (step_1),
        .touches (touches_1),
        .fresh   (fresh_1),
        .counts  (counts_2),
        .begins  (begins_2),
        .label   (label_2),
        .joins   (joins_2),
        .joined  (joined_2)
    );

    // ---- Stage 3: what it adds: its own, and what it joins. That was written at least two steps before: between two
    // runs of a row there is a taxel that does not touch
    (* ram_style = "distributed" *) reg [TOTAL-1:0] totals [0:(1<<LABEL_WIDTH)-1];
    wire [TOTAL-1:0] found = joins_2 ? totals[joined_2] : {TOTAL{1'b0}};
    reg [SUM_BITS-1:0] sum_3;
    reg [COUNT_BITS-1:0] taxels_3;
    reg [LABEL_WIDTH-1:0] label_3;
    reg [LABEL_WIDTH-1:0] joined_3;
    reg taxel_3;
    reg counts_3;
    reg begins_3;
    reg joins_3;

    always @(posedge clock) begin
        weight_2 <= weight_1;
        taxel_2 <= taxel_1;
        sum_3 <= found[COUNT_BITS +: SUM_BITS] + {{(SUM_BITS-DATA_BITS){1'b0}}, weight_2};
        taxels_3 <= found[COUNT_BITS-1:0] + 1'b1;
        label_3 <= label_2;
        joined_3 <= joined_2;
        taxel_3 <= taxel_2;
        counts_3 <= counts_2;
        begins_3 <= begins_2;
        joins_3 <= joins_2;
        if (reset) begin
            taxel_2 <= 1'b0;
            taxel_3 <= 1'b0;
        end
    end

    // ---- Stage 4: with what its run has
    reg [SUM_BITS-1:0] sum;
    reg [COUNT_BITS-1:0] taxels;
    reg [LABEL_WIDTH-1:0] label;
    reg [LABEL_WIDTH-1:0] joined;
    reg taxel;
    reg touches;
    reg joins;
    wire [SUM_BITS-1:0] grown = (begins_3 ? {SUM_BITS{1'b0}} : sum) + sum_3;
    wire [COUNT_BITS-1:0] more = (begins_3 ? {COUNT_BITS{1'b0}} : taxels) + taxels_3;

    assign there = taxel;
    assign record = {sum, taxels, joined, label, joins, touches};

    always @(posedge clock) begin
        if (counts_3) begin
            sum <= grown;
            taxels <= more;
            totals[label_3] <= {grown, more};
        end
        label <= label_3;
        joined <= joined_3;
        taxel <= taxel_3;
        touches <= counts_3;
        joins <= joins_3;
        if (reset) begin
            taxel <= 1'b0;
        end
    end

    wire _unused = &{1'b0, largest_5[5:0], rounded[5:0], longer[CONTROL_BITS*WEIGHT_LATENCY +: CONTROL_BITS]};

endmodule

`default_nettype wire

// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The forces of all taxels as whole numbers of a frame's step, in two banks: those that are parted, and the sums of
// those that the bodies are found to have.
//
// Takes the float32 words of a field, f_x, f_y, f_z of one taxel after the other, one a cycle at most; each replaces
// what stands in its bank or is added to it. Forces and sums are clipped. From a word to its place: 7 cycles.

`default_nettype none

module sptfra_forces #(
    // Taxels
    parameter TAXELS = 100,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3
) (
    input  wire clock,
    input  wire reset,
    // A field: its words, from the first after begins on
    input  wire begins,
    input  wire word_valid,
    input  wire [31:0] word,
    input  wire signed [9:0] unit, // power of two of a step; held
    input  wire adds, // held, with bank, until settled
    input  wire bank,
    output wire settled, // one cycle, with the last word in its place
    output reg  clips, // a word or a sum; at the latest with settled
    // A taxel, while no field comes: 1 cycle
    input  wire read_enable,
    input  wire [TAXEL_WIDTH:0] read_address, // bank in the highest bit
    output wire [80:0] forces // f_z, f_y, f_x
);

    localparam [31:0] LAST_TAXEL = TAXELS - 1;
    localparam signed [27:0] LARGEST = 28'sd67108863;

    // ---- Which word it is
    reg [1:0] component;
    reg [TAXEL_WIDTH-1:0] taxel;
    wire last = (component == 2'd2) && (taxel == LAST_TAXEL[TAXEL_WIDTH-1:0]);

    always @(posedge clock) begin
        if (word_valid) begin
            component <= (component == 2'd2) ? 2'd0 : component + 2'd1;
            if (component == 2'd2) begin
                taxel <= taxel + 1'b1;
            end
        end
        if (begins || reset) begin
            component <= 2'd0;
            taxel <= {TAXEL_WIDTH{1'b0}};
        end
    end

    // ---- Beside the conversion, 4 cycles; what is there already is read in its last one
    wire [25:0] magnitude;
    wire negative;
    wire clipped_3;
    reg clipped_4, clipped_5;
    wire signed [26:0] found_4;
    reg [6:1] valid;
    reg [6:1] is_last;
    reg [1:0] component_1, component_2, component_3, component_4, component_5, component_6;
    reg [TAXEL_WIDTH-1:0] taxel_1, taxel_2, taxel_3, taxel_4, taxel_5, taxel_6;

    sptfra_align #(
        .WIDTH (27)
    ) align (
        .clock      (clock),
        .enable     (1'b1),
        .float_bits (word),
        .unit       (unit),
        .magnitude  (magnitude),
        .negative   (negative),
        .clipped    (clipped_3),
        .fixed      (found_4)
    );

    always @(posedge clock) begin
        valid <= {valid[5:1], word_valid};
        is_last <= {is_last[5:1], word_valid && last};
        {component_6, component_5, component_4, component_3, component_2, component_1} <=
            {component_5, component_4, component_3, component_2, component_1, component};
        {taxel_6, taxel_5, taxel_4, taxel_3, taxel_2, taxel_1} <= {taxel_5, taxel_4, taxel_3, taxel_2, taxel_1, taxel};
        if (reset) begin
            valid <= 6'd0;
            is_last <= 6'd0;
        end
    end

    // ---- Stage 5: the sum; stage 6: clipped
    wire [26:0] there_4 = (component_4 == 2'd0) ? forces[26:0] : (component_4 == 2'd1) ? forces[53:27] : forces[80:54];
    reg signed [27:0] sum_5;
    reg signed [26:0] sum_6;
    wire above_5 = (sum_5 > LARGEST);
    wire below_5 = (sum_5 < -LARGEST);

    always @(posedge clock) begin
        sum_5 <= $signed({found_4[26], found_4}) + (adds ? $signed({there_4[26], there_4}) : 28'sd0);
        sum_6 <= sum_5[26:0];
        if (above_5) begin
            sum_6 <= LARGEST[26:0];
        end else if (below_5) begin
            sum_6 <= -LARGEST[26:0];
        end
        clipped_4 <= clipped_3;
        clipped_5 <= clipped_4;
        clips <= valid[5] && (clipped_5 || above_5 || below_5);
        if (reset) begin
            clips <= 1'b0;
        end
    end

    assign settled = is_last[6];

    // ---- One memory a component
    genvar index;

    generate
        for (index = 0; index < 3; index = index + 1) begin : gen_component
            localparam [1:0] COMPONENT = index;

            sptfra_ram #(
                .WIDTH         (27),
                .DEPTH         (2 << TAXEL_WIDTH),
                .ADDRESS_WIDTH (TAXEL_WIDTH + 1)
            ) component_memory (
                .clock         (clock),
                .write_enable  (valid[6] && (component_6 == COMPONENT)),
                .write_address ({bank, taxel_6}),
                .write_data    (sum_6),
                .read_enable   (read_enable || valid[3]),
                .read_address  (valid[3] ? {bank, taxel_3} : read_address),
                .read_data     (forces[27*index +: 27])
            );
        end
    endgenerate

    wire _unused = &{1'b0, magnitude, negative, taxel_4, taxel_5, component_5};

endmodule

`default_nettype wire

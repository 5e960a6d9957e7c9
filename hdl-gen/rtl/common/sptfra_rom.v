// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Read-only memory with a registered output, filled by $readmemh. Up to 4,096 words come from FILE. More words stand
// in banks of 4,096, each filled from bankNN_FILE.
//
// Latency: 1 cycle, held while enable is low. One read a cycle.
//
// A block memory holds 4,096 words of nine bits with its parity bits, which a deeper one cannot use. So banks take
// the fewest block memories. A register selects among the banks' outputs, in one LUT for three banks.

`default_nettype none

module sptfra_rom #(
    // Bits of a word
    parameter WIDTH = 18,
    // Words
    parameter DEPTH = 1024,
    // Bits of the address
    parameter ADDRESS_WIDTH = 10,
    // Prefix of the file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Hexadecimal words, one a line, as many as DEPTH
    parameter FILE = ""
) (
    input  wire                     clock,
    input  wire                     enable,
    input  wire [ADDRESS_WIDTH-1:0] address,
    output wire [WIDTH-1:0]         data
);

    localparam BANK_WIDTH = 12;
    localparam BANK = 1 << BANK_WIDTH;
    // More than 64 are more than a device has room for
    localparam BANKS = (DEPTH > 64 * BANK) ? 1 : (DEPTH + BANK - 1) / BANK;

    genvar bank;
    if (BANKS == 1) begin : gen_whole
        sptfra_ram #(
            .WIDTH         (WIDTH),
            .DEPTH         (DEPTH),
            .ADDRESS_WIDTH (ADDRESS_WIDTH),
            .ROM_DIR       (ROM_DIR),
            .FILE          (FILE),
            .WRITABLE      (0)
        ) whole (
            .clock         (clock),
            .write_enable  (1'b0),
            .write_address ({ADDRESS_WIDTH{1'b0}}),
            .write_data    ({WIDTH{1'b0}}),
            .read_enable   (enable),
            .read_address  (address),
            .read_data     (data)
        );
    end else begin : gen_banks
        localparam [79:0] DIGITS = "9876543210"; // 0 in the lowest bits
        wire [WIDTH*BANKS-1:0] words;
        reg  [BANKS-1:0] chosen;
        reg  [WIDTH-1:0] either;
        integer index;

        for (bank = 0; bank < BANKS; bank = bank + 1) begin : gen_bank
            localparam WORDS = (bank == BANKS - 1) ? DEPTH - bank * BANK : BANK;
            localparam WORDS_WIDTH = (WORDS > 2) ? $clog2(WORDS) : 1;
            localparam [ADDRESS_WIDTH-BANK_WIDTH-1:0] NUMBER = bank;
            localparam [15:0] TEXT = {DIGITS[8*(bank/10) +: 8], DIGITS[8*(bank%10) +: 8]};

            sptfra_ram #(
                .WIDTH         (WIDTH),
                .DEPTH         (WORDS),
                .ADDRESS_WIDTH (WORDS_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((FILE == "") ? "" : {"bank", TEXT, "_", FILE}),
                .WRITABLE      (0)
            ) of_bank (
                .clock         (clock),
                .write_enable  (1'b0),
                .write_address ({WORDS_WIDTH{1'b0}}),
                .write_data    ({WIDTH{1'b0}}),
                .read_enable   (enable),
                .read_address  (address[WORDS_WIDTH-1:0]),
                .read_data     (words[WIDTH*bank +: WIDTH])
            );

            always @(posedge clock) begin
                if (enable) begin
                    chosen[bank] <= (address[ADDRESS_WIDTH-1:BANK_WIDTH] == NUMBER);
                end
            end
        end

        always @(*) begin
            either = {WIDTH{1'b0}};
            for (index = 0; index < BANKS; index = index + 1) begin
                if (chosen[index]) begin
                    either = either | words[WIDTH*index +: WIDTH];
                end
            end
        end

        assign data = either;
    end

endmodule

`default_nettype wire
